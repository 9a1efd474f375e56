#include "controllers/recovery_controller.h"

#include <QDir>
#include <QStandardPaths>

#include "controllers/open_controller.h"
#include "controllers/save_controller.h"
#include "services/services.h"

namespace pellucid::gui {

RecoveryController::RecoveryController(Services& services, OpenController& opening, SaveController& saving)
    : m_services(services), m_opening(opening), m_saving(saving),
      m_writing(
          [this](const Work& work, const JobControl&) {
              work.session ? m_file->write(*work.session, work.title.toStdString()) : m_file->remove();
              return true;
          },
          [this](const Work&, bool&) {
              for (const std::string& path : std::exchange(m_restored, {})) discardRecovered(path);
          },
          WhenBusy::FinishOld) {
    connect(&m_writing, &JobBase::failed, this, &RecoveryController::sayUnkept);
}

QString RecoveryController::folder() {
    return QDir(QStandardPaths::writableLocation(QStandardPaths::AppDataLocation)).filePath("recovery");
}

void RecoveryController::sayUnkept(const Error& error) {
    m_services.notices().add({tr("Unsaved work cannot be kept: %1").arg(error.what())});
}

void RecoveryController::start() {
    if (m_file) return;
    try {
        m_file = std::make_shared<RecoveryFile>(folder().toStdString());
    } catch (const Error& error) {
        return sayUnkept(error);
    }
    // Not begun anew by each change: the first one that is not written yet decides.
    const auto changed = [this] {
        if (!m_timer.isActive()) m_timer.start();
    };
    connect(&m_services.store(), &SessionStore::changed, this, changed);
    connect(&m_services.store(), &SessionStore::historyChanged, this, changed);
}

void RecoveryController::save() {
    if (!m_file || !m_services.store().hasVolume()) return;
    Work work;
    if (!m_services.store().isClean()) work.session = m_services.store().committed().session;
    work.title = QString::fromStdString(m_services.scene().volume->title);
    m_writing.start(std::move(work), tr("the recovery file"));
}

void RecoveryController::discard() {
    m_timer.stop();
    if (m_file) m_writing.start({}, {});
}

void RecoveryController::offerWhenOpen() {
    const auto once = std::make_shared<bool>(true); // the first of the two that comes
    const auto offerOnce = [this, once] {
        if (std::exchange(*once, false)) offer();
    };
    connect(&m_opening, &OpenController::opened, this, offerOnce);
    connect(&m_opening, &OpenController::failed, this, offerOnce);
}

void RecoveryController::offer() {
    for (const Recovered& left : recoverableSessions(folder().toStdString())) {
        m_services.notices().add({tr("Pellucid closed before your work on %1 was saved. It was last kept at %2.")
                                      .arg(QString::fromStdString(left.title), QString::fromStdString(left.when)),
                                  {{tr("Restore work"), [this, path = left.path] { restore(path); }},
                                   {tr("Discard work"), [path = left.path] { discardRecovered(path); }}}});
    }
}

void RecoveryController::restore(const std::string& path) {
    m_services.attempt(tr("Cannot restore the work"), [&] {
        const SessionFile file = readSession(path);
        if (!m_saving.maybeSave()) return offer();
        // Once it is there again and written, this window keeps it.
        m_opening.openRecovered(file, [this, path] { m_restored.push_back(path); });
    });
}

} // namespace pellucid::gui
