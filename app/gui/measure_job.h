// Keeps the figures up to date without ever making the window wait.
#pragma once

#include <stop_token>

#include <QObject>
#include <QString>
#include <QTimer>

#include "compute_thread.h"
#include "models/document.h"

namespace pellucid::gui {

/// Measures the document's present state a moment after it last changed. The newest request wins: a measurement under
/// way is stopped as soon as its result would be out of date.
class MeasureJob : public QObject {
    Q_OBJECT
public:
    MeasureJob(Document& document, ComputeThread& thread, QObject* parent = nullptr);
    ~MeasureJob() override;

    /// While paused nothing is measured (an optimization uses the thread); going on measures anew.
    void setPaused(bool paused);
    /// Whether derivatives of VWS are measured too, after the figures.
    void setInfluenceWanted(bool wanted);
    bool isBusy() const { return m_running || m_delay.isActive(); }
    /// "cpu", "gl": what measured last; empty before.
    const QString& engineName() const { return m_engine; }

Q_SIGNALS:
    void busyChanged();
    void failed(const QString& what, const QString& where, const QString& whatToDo);

private:
    void request();
    void start();
    void stop();
    void finish(quint64 run);

    Document& m_document;
    ComputeThread& m_thread;
    QTimer m_delay;
    std::stop_source m_stop;
    quint64 m_run = 0; // numbers the requests, so that a late answer of a stopped one is dropped
    bool m_running = false, m_paused = false, m_influenceWanted = false;
    QString m_engine;
};

} // namespace pellucid::gui
