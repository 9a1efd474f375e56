#include "services/services.h"

#include <algorithm>

#include "dialogs/error_dialog.h"
#include "tf/shapes.h"

namespace pellucid::gui {

Services::Services(QWidget* window) : m_results(m_store, m_compute, m_workspace), m_window(window) {
    connect(&m_results, &Results::changed, this, &Services::idleChanged);
    connect(&m_results, &Results::failed, this, [this](const Error& error) {
        m_notices.add({tr("The figures could not be computed: %1").arg(QString::fromUtf8(error.what())), {}});
    });
}

int Services::selectedFeature() const { return featureWithId(scene().tf, m_selection.feature()); }

bool Services::isIdle() const {
    return m_store.hasVolume() && !m_results.isBusy() &&
           std::none_of(m_work.begin(), m_work.end(), [](const auto& isBusy) { return isBusy(); });
}

void Services::undo() {
    try {
        if (!isReadOnly() && m_store.canUndo()) m_store.undo();
    } catch (const Error& error) { // a file of that state has gone: the present state stays
        showError(tr("This cannot be undone now"), error);
    }
}

void Services::redo() {
    try {
        if (!isReadOnly() && m_store.canRedo()) m_store.redo();
    } catch (const Error& error) {
        showError(tr("This cannot be done again now"), error);
    }
}

void Services::showError(const QString& title, const Error& error) { pellucid::gui::showError(m_window, title, error); }

} // namespace pellucid::gui
