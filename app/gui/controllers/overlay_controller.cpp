#include "controllers/overlay_controller.h"

#include "controllers/open_controller.h"
#include "dialogs/ask_file.h"
#include "dialogs/ask_preset.h"
#include "dialogs/series_files.h"
#include "services/services.h"
#include "store/edits.h"
#include "tf/formats/tf_file.h"

namespace pellucid::gui {

void OverlayController::addActions() {
    ActionMenu file(m_services.actions(), tr("&File"), [this] { return m_services.isEditable(); });
    file.separate();
    file.add("addOverlayAction", tr("Add o&verlay…"), {},
             tr("A second volume over this one, where both lie in the world: a t-map on its anatomy, a dose on its CT"),
             [this] { choose(); });
    file.add("removeOverlayAction", tr("Re&move overlay"), {}, tr("Draw this volume alone again"), [this] { remove(); },
             {.enabled = [this] { return m_services.isEditable() && hasAny(); }});
}

bool OverlayController::hasAny() const { return !m_services.store().session().overlay->isNone(); }

void OverlayController::choose() {
    if (const auto source = m_opening.askSource(tr("Add overlay"))) lay(*source);
}

void OverlayController::lay(const VolumeSource& source) {
    const auto tell = [this] {
        if (const auto& overlay = m_services.scene().overlay)
            for (const std::string& notice : overlay->notices)
                m_services.notices().add({QString::fromStdString(notice)});
    };
    m_opening.editInJob(tr("Overlay %1").arg(titleOf(source)),
                        changing(&Session::overlay,
                                 [source](OverlayView& o) {
                                     o = {};
                                     o.source = source;
                                 }),
                        tell);
}

void OverlayController::remove() {
    m_services.store().edit(tr("Remove overlay"), {}, [](Session& s) { s.overlay.set({}); });
}

void OverlayController::setShown(bool shown) {
    m_opening.editInJob(shown ? tr("Show overlay") : tr("Hide overlay"),
                        changing(&Session::overlay, [shown](OverlayView& o) { o.shown = shown; }));
}

void OverlayController::chooseCurve() {
    const QString path = QFileDialog::getOpenFileName(
        m_services.window(), tr("Transfer function of the overlay"), keptFolder("tfFolder"),
        tr("Transfer functions (%1 *.json);;All files (*)").arg(tfPatterns()));
    if (path.isEmpty()) return;
    keepFolderOf("tfFolder", path);
    if (const QString one = askPreset(path, m_services.window()); !one.isEmpty()) openCurve(one);
}

void OverlayController::openCurve(const QString& path) {
    m_services.attempt(tr("Cannot open the transfer function"), [&] {
        const ReadTf read = readTfNamed(path.toStdString());
        const Scene& scene = m_services.scene();
        const Geometry& geometry = scene.data->geometry();
        const TransferFunction curve = forVolume(read, geometry);
        editPart(m_services.store(), &Session::overlay, tr("Transfer function of the overlay"), {},
                 [&](OverlayView& o) { o.curve = curve; });
        const std::optional<ValueRange> values =
            scene.overlay ? std::optional(scene.overlay->volume->range()) : std::nullopt;
        for (const std::string& notice : openingNotices(read, geometry, values))
            m_services.notices().add({QString::fromStdString(notice)});
    });
}

void OverlayController::removeCurve() {
    editPart(m_services.store(), &Session::overlay, tr("Overlay by threshold and colours"), {},
             [](OverlayView& o) { o.curve.reset(); });
}

} // namespace pellucid::gui
