#include "controllers/orientation_controller.h"

#include <utility>

#include <QMessageBox>

#include <glm/common.hpp>

#include "controllers/open_controller.h"
#include "dialogs/axes_dialog.h"
#include "dialogs/spacing_dialog.h"
#include "services/services.h"
#include "session/variable_edits.h"
#include "volume/mirror_image.h"

namespace pellucid::gui {
namespace {

/// The world's axis that a direction is nearest to, 0, 1 or 2.
int nearestAxis(const Vec3& direction) {
    const Vec3 size = glm::abs(direction);
    return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

} // namespace

OrientationController::OrientationController(Services& services, OpenController& opening)
    : m_services(services), m_opening(opening) {
    connect(&services.store(), &SessionStore::changed, this, [this](const Scene& before, const Scene& after) {
        if (before.data == after.data) return;
        tell();
        noteSpacing(before, after);
    });
    connect(&services.store(), &SessionStore::historyChanged, this, &OrientationController::follow);
    connect(&opening, &OpenController::opened, this, &OrientationController::tell); // its notices have taken this away
}

void OrientationController::addActions() {
    SessionStore& store = m_services.store();
    const auto canTurn = [this, &store] { return m_services.isEditable() && store.hasVolume(); };
    ActionMenu menu(m_services.actions(), tr("&Edit") + "/" + tr("&Orientation of the data"), canTurn);
    const auto addTurn = [&](const char* id, const QString& text, const QString& tip, auto about) {
        menu.add(id, text, {}, tip,
                 [this, &store, about, step = QString(text).remove('&')] { turn(step, about(store.scene().camera)); });
    };
    addTurn("turnLeftAction", tr("Turn &left"), tr("A quarter turn: what faces you goes to the left"),
            [](const Camera& c) { return -c.trueUp(); });
    addTurn("turnRightAction", tr("Turn &right"), tr("A quarter turn: what faces you goes to the right"),
            [](const Camera& c) { return c.trueUp(); });
    addTurn("tipForwardAction", tr("Tip &forward"), tr("A quarter turn: the top comes toward you"),
            [](const Camera& c) { return c.right(); });
    addTurn("tipBackAction", tr("Tip &back"), tr("A quarter turn: the top goes away from you"),
            [](const Camera& c) { return -c.right(); });
    addTurn("turnClockwiseAction", tr("Turn &clockwise"), tr("A quarter turn in the picture"),
            [](const Camera& c) { return c.forward(); });
    addTurn("turnAnticlockwiseAction", tr("Turn &anticlockwise"), tr("A quarter turn in the picture"),
            [](const Camera& c) { return -c.forward(); });
    menu.separate();
    menu.add("mirrorAction", tr("&Mirror"), {},
             tr("Left and right change places: for files that were written the wrong way round"),
             [this, &store] { mirror(store.scene().camera.right()); });
    menu.separate();
    menu.add("sayAxesAction", tr("&Set axis directions…"), {},
             tr("Which way each axis of the file points: left, front, head, or along x, y, z"), [this] { choose(); });
    menu.add("axesOfFileAction", tr("Reset to &file orientation"), {},
             tr("What the file says of its orientation holds again"),
             [this] { set(tr("Reset to file orientation"), {}); },
             {.enabled = [this, canTurn] { return canTurn() && source().axes.has_value(); }});
    ActionMenu edit(m_services.actions(), tr("&Edit"), canTurn);
    edit.add("spacingAction", tr("&Voxel spacing…"), {},
             tr("The distances between voxels and their unit, for files that leave them out or get them wrong"),
             [this] { chooseSpacing(); });
    edit.add("spacingOfFileAction", tr("Reset to fi&le spacing"), {}, tr("Use the spacing that the file states"),
             [this] { setSpacing(tr("Reset to file spacing"), {}); },
             {.enabled = [this, canTurn] { return canTurn() && source().spacing.has_value(); }});
}

const VolumeSource& OrientationController::source() const { return dataVariable(m_services.store().session()).source; }

GridAxes OrientationController::now() const { return nearestAxes(m_services.scene().data->geometry()); }

void OrientationController::turn(const QString& text, const Vec3& about) {
    const int axis = nearestAxis(about);
    GridAxes axes = now();
    for (int quarter = about[axis] > 0 ? 1 : 3; quarter > 0; --quarter) axes = turned(axes, axis);
    set(text, axes);
}

void OrientationController::mirror(const Vec3& along) {
    if (m_services.scene().data->geometry().worldAxes == WorldAxes::Patient &&
        QMessageBox::question(m_services.window(), tr("Mirror"),
                              tr("What is on the patient's left will be shown on the right. Mirror only data that you "
                                 "know were written the wrong way round. Mirror?"),
                              QMessageBox::Yes | QMessageBox::Cancel, QMessageBox::Cancel) != QMessageBox::Yes)
        return;
    set(tr("Mirror"), mirrored(now(), nearestAxis(along)));
}

void OrientationController::tell() {
    Notices& notices = m_services.notices();
    if (!m_told.isEmpty()) notices.remove(m_told);
    m_told.clear();
    const auto& data = m_services.scene().data;
    if (!data || !source().axes) return;
    m_told = isMirrorImage(*data) ? tr("Mirrored: left and right are not as in the file.")
                                  : tr("Turned: the data do not lie as the file says.");
    notices.add({m_told, {{tr("Reset to file orientation"), [this] { set(tr("Reset to file orientation"), {}); }}}});
}

void OrientationController::noteSpacing(const Scene& before, const Scene& after) {
    m_spaced.reset();
    if (!before.data || !after.data || before.session.isEmpty() || after.session.isEmpty()) return;
    const VolumeSource &was = dataVariable(before.session).source, &is = dataVariable(after.session).source;
    const Geometry &from = before.data->geometry(), &to = after.data->geometry();
    if (was.spacing != is.spacing && was.path == is.path && from.dims == to.dims) m_spaced = {from, to};
}

void OrientationController::follow() {
    SessionStore& store = m_services.store();
    const auto spaced = std::exchange(m_spaced, {});
    if (!spaced || (!store.canUndo() && !store.canRedo())) return; // it is no step: it has just been opened
    store.setCamera(cameraOfSpaced(m_services.scene().camera, spaced->first, spaced->second));
}

void OrientationController::place(const QString& text, const std::optional<GridAxes>& axes,
                                  const std::optional<GridSpacing>& spacing) {
    m_services.attempt(tr("The data cannot lie like that"), [&] {
        const auto change = [axes, spacing, data = m_services.scene().data](Session& session) {
            placeData(session, *data, axes, spacing);
        };
        m_opening.editData(text, change, [this] { tell(); });
    });
}

void OrientationController::set(const QString& text, const std::optional<GridAxes>& axes) {
    place(text, axes, source().spacing);
}

void OrientationController::setSpacing(const QString& text, const std::optional<GridSpacing>& spacing) {
    place(text, source().axes, spacing);
}

void OrientationController::chooseSpacing() {
    SpacingDialog dialog(spacingOfData(*m_services.scene().data), m_services.window());
    if (dialog.exec() == QDialog::Accepted) setSpacing(tr("Voxel spacing"), dialog.spacing());
}

void OrientationController::choose() {
    AxesDialog dialog(now(), m_services.scene().data->dims(), m_services.window());
    if (dialog.exec() == QDialog::Accepted) set(tr("Orientation"), dialog.axes());
}

} // namespace pellucid::gui
