// Opening: volumes, transfer functions and sessions, from every place that names one.
#pragma once

#include <deque>

#include <QObject>
#include <QStringList>

#include "jobs/background_work.h"
#include "session/session_json.h"
#include "store/session_store.h"
#include "volume/file_contents.h"

class QAction;

namespace pellucid::gui {

class SaveController;
class Services;

class OpenController : public BackgroundWork {
    Q_OBJECT
public:
    OpenController(Services& services, SaveController& saving);

    void addActions();
    /// Fills the menu of recent files; after the menus have been built.
    void updateRecentFiles();

    /// All of these open in the background; an error shows a dialog and leaves everything as it is.
    /// `tfSpec` (a file, auto, tents:N[:PEAK], ramp:N, preset:NAME) is the transfer function; empty: the automatic
    /// start.
    void openVolume(const VolumeSource& source, const QString& tfSpec = {});
    void openSession(const QString& path);
    /// A session that need not have a file: one that was recovered. It is unsaved. `then` once it is open; never where
    /// that fails or something else is opened meanwhile.
    void openRecovered(const SessionFile& file, const std::function<void()>& then);
    /// Into the present session, at once.
    void openTf(const QString& specOrPath);
    /// A path from the user: a session or a transfer function by its name, or a picture that carries a session, else a
    /// volume; what no format knows asks for its layout. Asks about unsaved work.
    void openPath(const QString& path);
    /// Several at once: one is as openPath(); volumes are the frames of one series, in the order in which people count;
    /// a transfer function among them is opened with them.
    void openPaths(QStringList paths);
    /// The same as the first thing of a window, with a transfer function.
    void openAtStart(const QStringList& paths, const QString& tfSpec);
    /// Asks for the files of a volume or series, and for their layout where they have no header: for those who add it
    /// to what is open. Empty: the user gave up.
    std::optional<VolumeSource> askSource(const QString& title);
    std::optional<VolumeSource> askSeries(); ///< likewise, by a folder or pattern

    /// A change of the session that needs other data, or the same through another window: one undo step named `text`
    /// once the data is there; `then` follows it. A later one of the same name takes the place of one under way, others
    /// wait for it.
    void editData(const QString& text, const SessionStore::Change& change, const std::function<void()>& then = {});
    /// The same where no other data is needed, but what follows of it takes time: variables that are read, colours that
    /// are made of several of them, a ground, an overlay.
    void editInJob(const QString& text, const SessionStore::Change& change, const std::function<void()>& then = {});

    bool isBusy() const override { return m_open.isRunning() || m_data.isRunning() || m_look.isRunning(); }
    QString busyText() const override { return m_busyText; }
    void cancel() override;

Q_SIGNALS:
    void opened(); ///< a volume or a session
    void failed(const pellucid::Error& error);
    void tfFailed(const pellucid::Error& error); ///< the volume is open, its transfer function is the default
    void automaticStartWanted();                 ///< in the place of a transfer function

private:
    struct Request {
        SceneInputs inputs;
        QString tfPath, sessionPath;
        std::vector<std::string> notices;
        bool tfIsOptional = false; ///< a wrong one is no reason not to show the volume
        bool unsaved = false;
        std::function<void()> then; ///< once it is open
    };
    struct Opened {
        Scene scene;
        std::optional<Error> tfError;
    };
    struct Look {
        VolumeSource source;
        QString tfSpec;
    };
    struct DataChange {
        QString text;
        SessionStore::Change change;
        Scene basis;
    };
    struct Edit {
        QString text;
        SessionStore::Change change;
        std::function<void()> then;
    };

    void begin(Request request, const QString& where);
    /// Says why nothing was opened; where files outside a folder are named it asks, and may begin again.
    void showFailure(const Error& error);
    void start(Edit edit);
    void nextChange();
    void showChanged(const DataChange& change, Scene& scene);
    static Opened load(const Request& request, const JobControl& job);
    void show(const Request& request, Opened& opened);
    /// Does something that may throw Error, which is shown then, and told by failed().
    void attempt(const QString& title, const std::function<void()>& work);
    void showNotices(const std::vector<std::string>& notices);
    /// What the clipping box leaves of the data, at full resolution; and back.
    void openRegion();
    void openWhole();
    void openPart(const QString& text, const std::optional<VoxelRegion>& region); ///< empty: all
    /// openVolume(), after the question which series is meant where there are several.
    void openChosen(const VolumeSource& source, const QString& tfSpec = {});
    void openSeries(const Look& look, const FileContents& contents); ///< after that question
    bool askRawLayout(VolumeSource& source);                         ///< false: the user gave up
    bool askLayout(VolumeSource& source, const QStringList& files);  ///< likewise
    void chooseVolume();
    void chooseFolder();
    void openCopied(); ///< what the clipboard names
    void chooseSeries();
    QStringList askFiles(const QString& title, const QString& others);
    void chooseRaw();
    void chooseTf();
    void askAndOpenTf(const QString& path); ///< openTf(), after the question which one is meant where there are several
    void noteWindow(const TransferFunction& tf);
    void addRecent(const QString& entry);
    void openRecent(const QString& entry);

    Services& m_services;
    SaveController& m_saving;
    QAction* m_clearRecent = nullptr;
    QString m_busyText;
    Request m_request;        ///< the latest one
    Edit m_edit;              ///< the one under way
    std::deque<Edit> m_edits; ///< those that wait for it
    Job<Request, Opened> m_open;
    Job<DataChange, Scene> m_data;
    Job<Look, FileContents> m_look; ///< at what a path holds, before it is opened
};

} // namespace pellucid::gui
