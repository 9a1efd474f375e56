#include "measure_job.h"

#include <new>

namespace pellucid::gui {

MeasureJob::MeasureJob(Document& document, ComputeThread& thread, QObject* parent)
    : QObject(parent), m_document(document), m_thread(thread) {
    // Long enough that a drag does not start one measurement per mouse event, short enough to feel immediate.
    m_delay.setInterval(120);
    m_delay.setSingleShot(true);
    connect(&m_delay, &QTimer::timeout, this, &MeasureJob::start);
    connect(&document, &Document::volumeChanged, this, &MeasureJob::request);
    connect(&document, &Document::tfChanged, this, &MeasureJob::request);
    connect(&document, &Document::cameraChanged, this, &MeasureJob::request);
}

MeasureJob::~MeasureJob() { m_stop.request_stop(); }

void MeasureJob::setPaused(bool paused) {
    if (m_paused == paused) return;
    m_paused = paused;
    if (paused) {
        stop();
    } else {
        request();
    }
}

void MeasureJob::setInfluenceWanted(bool wanted) {
    if (m_influenceWanted == wanted) return;
    m_influenceWanted = wanted;
    if (wanted && !m_document.influenceIsCurrent()) request();
}

void MeasureJob::stop() {
    m_stop.request_stop();
    ++m_run;
    m_running = false;
    m_delay.stop();
    Q_EMIT busyChanged();
}

void MeasureJob::request() {
    if (m_paused || !m_document.hasVolume()) return;
    stop();
    m_delay.start();
    Q_EMIT busyChanged();
}

void MeasureJob::start() {
    m_stop = std::stop_source();
    m_running = true;
    Q_EMIT busyChanged();
    const JobControl job{m_stop.get_token(), {}};
    // Answers are posted to this object, which goes only after the thread has been joined.
    m_thread.submit([this, job, run = ++m_run, influenceToo = m_influenceWanted, version = m_document.version(),
                     volume = m_document.volume(), tf = m_document.tf(),
                     camera = m_document.camera()](ComputeCache& cache) {
        try {
            job.throwIfStopped();
            VisibilityEngine& engine = cache.engine(volume);
            const WeightFields& weights = cache.weights(volume, tf, job);
            Measures measures = measure(engine, camera, tf, weights, {}, job);
            const QString engineName = QString::fromStdString(engine.name());
            QMetaObject::invokeMethod(this,
                                      [this, run, version, influenceToo, engineName, measures = std::move(measures)] {
                                          if (run != m_run) return;
                                          m_engine = engineName;
                                          if (!influenceToo) finish(run);
                                          m_document.setMeasures(measures, version);
                                      });
            if (!influenceToo) return;
            auto influence = vwsJacobian(engine.jacobian(camera, tf, &weights, job));
            QMetaObject::invokeMethod(this, [this, run, version, influence = std::move(influence)] {
                if (run != m_run) return;
                finish(run);
                m_document.setInfluence(influence, version);
            });
        } catch (const Cancelled&) {
            // Nobody waits for it: whoever stopped it has gone on.
        } catch (const Error& error) {
            QMetaObject::invokeMethod(this, [this, run, error] {
                if (run != m_run) return;
                finish(run);
                Q_EMIT failed(QString::fromStdString(error.problem()), QString::fromStdString(error.where()),
                              QString::fromStdString(error.whatToDo()));
            });
        } catch (const std::bad_alloc&) {
            QMetaObject::invokeMethod(this, [this, run] {
                if (run != m_run) return;
                finish(run);
                Q_EMIT failed(tr("not enough memory to measure the volume"), m_document.title(),
                              tr("close other programs, or open a smaller volume"));
            });
        } catch (const std::exception& error) { // ours to mend, but no reason to end the program
            QMetaObject::invokeMethod(this, [this, run, what = QString::fromLocal8Bit(error.what())] {
                if (run != m_run) return;
                finish(run);
                Q_EMIT failed(tr("unexpected failure: %1").arg(what), m_document.title(), tr("please report this"));
            });
        }
    });
}

void MeasureJob::finish(quint64 run) {
    if (run == m_run) m_running = false;
    Q_EMIT busyChanged();
}

} // namespace pellucid::gui
