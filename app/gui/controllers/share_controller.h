// Web pages of what the window shows.
#pragma once

#include <memory>

#include <QObject>

#include "jobs/job.h"

namespace pellucid {
struct SharedPage;
struct ShareTask;
} // namespace pellucid

namespace pellucid::gui {

class Services;

class ShareController : public QObject {
    Q_OBJECT
public:
    explicit ShareController(Services& services);
    ~ShareController() override;

    void addActions();

    void cancel() { m_job.cancel(); }
    bool isBusy() const { return m_job.isRunning(); }
    QString busyText() const;

Q_SIGNALS:
    void busyChanged();
    void progress(double fraction);
    void cancelled();
    void saved(const QString& path);

private:
    void choose();
    void tell(const ShareTask& task, const SharedPage& page);

    Services& m_services;
    QString m_name; ///< of the file that is being written
    Job<std::shared_ptr<const ShareTask>, std::shared_ptr<const SharedPage>> m_job;
};

} // namespace pellucid::gui
