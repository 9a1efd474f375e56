// What works in the background and is shown in the status line while it does.
#pragma once

#include <memory>

#include <QFileInfo>
#include <QObject>

#include "jobs/job.h"

namespace pellucid::gui {

class BackgroundWork : public QObject {
    Q_OBJECT
public:
    virtual bool isBusy() const = 0;
    virtual QString busyText() const = 0; ///< "Opening scan.nrrd…"
    virtual void cancel() = 0;

Q_SIGNALS:
    void busyChanged();
    void progress(double fraction);
    void cancelled();

protected:
    /// What the job says of itself is said of this.
    void follow(JobBase& job) {
        connect(&job, &JobBase::busyChanged, this, &BackgroundWork::busyChanged);
        connect(&job, &JobBase::progress, this, &BackgroundWork::progress);
        connect(&job, &JobBase::cancelled, this, &BackgroundWork::cancelled);
    }
};

/// Makes files, one after the other, of tasks that have a `path`.
template <class Task, class Result>
class FileWork : public BackgroundWork {
public:
    bool isBusy() const override { return m_job.isRunning(); }
    QString busyText() const override { return tr("Saving %1…").arg(m_name); }
    void cancel() override { m_job.cancel(); }

protected:
    using FileJob = Job<std::shared_ptr<const Task>, std::shared_ptr<const Result>>;

    template <class Make, class Tell>
    FileWork(const Make& make, const Tell& tell)
        : m_job([make](const std::shared_ptr<const Task>& task,
                       const JobControl& job) { return std::make_shared<const Result>(make(*task, job)); },
                [tell](const std::shared_ptr<const Task>& task, std::shared_ptr<const Result>& result) {
                    tell(*task, *result);
                },
                WhenBusy::Queue) {
        follow(m_job);
    }
    void start(const Task& task) {
        const QString path = QString::fromStdString(task.path);
        m_name = QFileInfo(path).fileName();
        m_job.start(std::make_shared<const Task>(task), path);
        Q_EMIT busyChanged();
    }
    JobBase& job() { return m_job; }

private:
    QString m_name; ///< of the file that is being written
    FileJob m_job;
};

} // namespace pellucid::gui
