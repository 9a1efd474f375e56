#include "services/services.h"

#include <algorithm>

#include <QDir>
#include <QFileInfo>

#include "dialogs/error_dialog.h"
#include "tf/shapes.h"

namespace pellucid::gui {

Services::Services(QWidget* window) : m_results(m_store, m_compute, m_workspace), m_window(window) {
    connect(&m_results, &Results::changed, this, &Services::idleChanged);
    connect(&m_results, &Results::failed, this, [this](const Error& error) {
        m_notices.add({tr("The figures could not be computed: %1").arg(error.what())});
    });
}

int Services::selectedFeature() const { return featureWithId(scene().tf, m_selection.feature()); }

const Feature* Services::selected() const {
    const int index = selectedFeature();
    return index < 0 ? nullptr : &scene().tf.features[static_cast<std::size_t>(index)];
}

bool Services::isIdle() const {
    return m_store.hasVolume() && !m_results.isBusy() &&
           std::none_of(m_work.begin(), m_work.end(), [](const auto& isBusy) { return isBusy(); });
}

// A file of the other state may have gone: then the present state stays.
void Services::undo() {
    if (isReadOnly() || !m_store.canUndo()) return;
    const QString step = m_store.undoText();
    if (attempt(tr("This cannot be undone now"), [this] { m_store.undo(); }))
        Q_EMIT message(tr("Undone: %1").arg(step));
}

void Services::redo() {
    if (isReadOnly() || !m_store.canRedo()) return;
    const QString step = m_store.redoText();
    if (attempt(tr("This cannot be done again now"), [this] { m_store.redo(); }))
        Q_EMIT message(tr("Done again: %1").arg(step));
}

void Services::saySaved(const QString& path, const QString& more) {
    const QFileInfo file(path);
    const QString text = tr("Saved %1 in %2").arg(file.fileName(), QDir::toNativeSeparators(file.absolutePath()));
    Q_EMIT message(more.isEmpty() ? text : tr("%1 (%2)").arg(text, more));
}

void Services::showError(const QString& title, const Error& error) { pellucid::gui::showError(m_window, title, error); }

bool Services::attempt(const QString& title, const std::function<void()>& work) {
    try {
        work();
        return true;
    } catch (const Error& error) {
        showError(title, error);
        return false;
    }
}

void Services::showFailuresOf(JobBase& job, const QString& title) {
    connect(&job, &JobBase::failed, this, [this, title](const Error& error) { showError(title, error); });
}

} // namespace pellucid::gui
