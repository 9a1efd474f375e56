// Unsaved work that survives a crash.
#pragma once

#include <memory>

#include <QObject>

#include "jobs/job.h"
#include "jobs/rest_timer.h"
#include "session/recovery.h"

namespace pellucid::gui {

class OpenController;
class SaveController;
class Services;

/// Writes the session to a recovery file within two seconds of every change that is not saved, and offers at the next
/// start what a crash left behind.
class RecoveryController : public QObject {
    Q_OBJECT
public:
    RecoveryController(Services& services, OpenController& opening, SaveController& saving);

    /// Where recovery files lie for this user.
    static QString folder();
    /// Begins to keep unsaved work; a window that is only photographed does not.
    void start();
    /// A notice with what was left behind, if anything was, once the first volume is open.
    void offerWhenOpen();
    void offer();
    /// The user has decided about the work at hand: nothing is kept.
    void discard();

private:
    struct Work {
        std::optional<Session> session; ///< empty: there is nothing to keep
        QString title;
    };
    void save();
    void sayUnkept(const Error& error);
    void restore(const std::string& path);

    Services& m_services;
    OpenController& m_opening;
    SaveController& m_saving;
    std::shared_ptr<RecoveryFile> m_file; // shared with the thread that writes it
    /// Milliseconds from the first change to the file: with the writing well below two seconds.
    RestTimer m_timer{800, [this] { save(); }};
    std::vector<std::string> m_restored; ///< files of others whose work is here now, until it is written
    Job<Work, bool> m_writing;
};

} // namespace pellucid::gui
