#include "services/services.h"

#include "controllers/annotation_actions.h"
#include "controllers/feature_actions.h"
#include "controllers/field_controller.h"
#include "controllers/live_controller.h"
#include "controllers/open_controller.h"
#include "controllers/optimize_controller.h"
#include "controllers/player_controller.h"
#include "controllers/recovery_controller.h"
#include "controllers/refine_controller.h"
#include "controllers/save_controller.h"
#include "controllers/slice_actions.h"
#include "controllers/start_controller.h"
#include "controllers/target_actions.h"
#include "controllers/tf_actions.h"
#include "controllers/theme_actions.h"
#include "controllers/view_actions.h"
#include "dialogs/error_dialog.h"

namespace pellucid::gui {

Services::Services(QWidget* window) : m_results(m_store, m_compute, m_workspace), m_window(window) {
    m_optimizing = std::make_unique<OptimizeController>(*this);
    m_refining = std::make_unique<RefineController>(*this);
    m_fields = std::make_unique<FieldController>(*this);
    m_live = std::make_unique<LiveController>(*this);
    m_saving = std::make_unique<SaveController>(*this);
    m_opening = std::make_unique<OpenController>(*this);
    m_start = std::make_unique<StartController>(*this);
    m_recovery = std::make_unique<RecoveryController>(*this);
    m_player = std::make_unique<PlayerController>(*this);

    // The menus stand in the order in which their first actions come.
    m_opening->addActions();
    m_saving->addActions();
    addEditActions();
    m_start->addActions();
    addTfActions(*this);
    addFeatureActions(*this);
    m_refining->addActions();
    addTargetActions(*this);
    m_optimizing->addActions();
    m_live->addActions();
    addViewActions(*this);
    addAnnotationActions(*this);
    m_fields->addActions();
    addSliceActions(*this);
    m_player->addActions();
    addThemeActions(*this);

    connect(&m_store, &SessionStore::historyChanged, &m_actions, &Actions::refresh);
    connect(&m_store, &SessionStore::changed, this, [this](const Scene& before, const Scene& after) {
        if (before.volume != after.volume || before.tf.features.empty() != after.tf.features.empty() ||
            before.camera.projection != after.camera.projection ||
            before.session.reference != after.session.reference ||
            !before.session.slices.isSame(after.session.slices) || !before.session.field.isSame(after.session.field))
            m_actions.refresh();
    });
    connect(&m_results, &Results::changed, this, &Services::idleChanged);
    connect(&m_results, &Results::failed, this, [this](const Error& error) {
        m_notices.add({tr("The figures could not be computed: %1").arg(QString::fromUtf8(error.what())), {}});
    });
    connect(m_optimizing.get(), &OptimizeController::runningChanged, this, [this] {
        m_actions.refresh();
        Q_EMIT readOnlyChanged();
        Q_EMIT idleChanged();
    });
    connect(m_optimizing.get(), &OptimizeController::messageChanged, this, &Services::idleChanged);
    connect(m_opening.get(), &OpenController::busyChanged, this, &Services::idleChanged);
    connect(m_refining.get(), &RefineController::busyChanged, this, &Services::idleChanged);
    connect(m_live.get(), &LiveController::busyChanged, this, &Services::idleChanged);
    connect(m_start.get(), &StartController::busyChanged, this, &Services::idleChanged);
    connect(m_saving.get(), &SaveController::busyChanged, this, &Services::idleChanged);
    connect(m_fields.get(), &FieldController::busyChanged, this, &Services::idleChanged);
    connect(m_player.get(), &PlayerController::changed, this, &Services::idleChanged);
}

Services::~Services() {
    m_store.disconnect(); // what ends below must not be heard by what has ended already
    m_results.disconnect();
    m_player.reset();
    m_recovery.reset();
    m_start.reset();
    m_opening.reset();
    m_saving.reset();
    m_fields.reset();
    m_live.reset();
    m_refining.reset();
    m_optimizing.reset();
}

void Services::addEditActions() {
    const auto keys = [](auto... texts) { return QList<QKeySequence>{QKeySequence(texts)...}; };
    m_actions.add({.id = "undoAction",
                   .menu = tr("&Edit"),
                   .text = tr("&Undo"),
                   .keys = keys("Ctrl+Z"),
                   .trigger = [this] { goBack([this] { m_store.undo(); }, tr("This cannot be undone now")); },
                   .enabled = [this] { return !isReadOnly() && m_store.canUndo(); },
                   .say = [this] { return m_store.canUndo() ? tr("Undo: %1").arg(m_store.undoText()) : tr("Undo"); },
                   .inToolBar = true});
    m_actions.add({.id = "redoAction",
                   .menu = tr("&Edit"),
                   .text = tr("&Redo"),
                   .keys = keys("Ctrl+Shift+Z", "Ctrl+Y"),
                   .trigger = [this] { goBack([this] { m_store.redo(); }, tr("This cannot be done again now")); },
                   .enabled = [this] { return !isReadOnly() && m_store.canRedo(); },
                   .say = [this] { return m_store.canRedo() ? tr("Redo: %1").arg(m_store.redoText()) : tr("Redo"); },
                   .inToolBar = true});
}

void Services::goBack(const std::function<void()>& step, const QString& failure) {
    try {
        step();
    } catch (const Error& error) { // a file of that state has gone: the present state stays
        showError(failure, error);
    }
}

bool Services::isReadOnly() const { return m_optimizing->isRunning(); }

bool Services::isIdle() const {
    return m_store.hasVolume() && !m_opening->isBusy() && !m_start->isBusy() && !m_saving->isBusy() &&
           !m_optimizing->isRunning() && !m_optimizing->isExplaining() && !m_refining->isBusy() && !m_live->isBusy() &&
           !m_results.isBusy() && !m_fields->isBusy() && !m_player->isBusy();
}

void Services::showError(const QString& title, const Error& error) { pellucid::gui::showError(m_window, title, error); }

} // namespace pellucid::gui
