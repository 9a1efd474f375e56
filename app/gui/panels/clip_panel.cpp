// The panel of what is cut away: the part of the box, and oblique planes. Picture and figures are of what is left. And
// how dense what the object lies on is drawn.
#include <array>

#include <QGridLayout>
#include <QLabel>
#include <QPushButton>

#include <glm/geometric.hpp>

#include "controllers/controllers.h"
#include "panels/panel.h"
#include "panels/panel_parts.h"
#include "render/clip_handles.h"
#include "store/known_holder.h"
#include "volume/orientation.h"
#include "widgets/controls.h"
#include "widgets/layouts.h"
#include "widgets/number_box.h"
#include "widgets/number_text.h"

namespace pellucid::gui {
namespace {

constexpr const char* kAxes[] = {"x", "y", "z"};

void addPlane(Services& services, QAction& handles) {
    const Scene& scene = services.scene();
    const ClipPlane plane = planeFacing(scene.camera, scene.volume->geometry());
    editPart(services.store(), &Session::clipping, QObject::tr("Clip plane"), {},
             [&](Clipping& c) { c.planes.push_back(plane); });
    if (!handles.isChecked()) handles.trigger(); // it is there to be moved
}

void clipNothing(Services& services) {
    services.store().edit(QObject::tr("Remove clipping"), {},
                          [](Session& session) { session.clipping.edit([](Clipping& c) { c.setPart({}); }); });
}

class ClipPanel : public QWidget {
public:
    /// `handles` shows them in the picture.
    ClipPanel(Services& services, QAction& handles, QWidget* parent);

    QSize sizeHint() const override { return sizeWithoutScrolling(*this); }

private:
    /// One oblique plane; hidden where there is none of its number.
    struct PlaneRow {
        QWidget* widget;
        std::array<QDoubleSpinBox*, 4> boxes; ///< normal, offset
    };
    QLayout* makeBox();
    PlaneRow makeRow(std::size_t index);
    void follow();
    void nameAxis(std::size_t axis, const Geometry& geometry);
    void editBox(int axis, bool upper, double percent);
    void editPlane(std::size_t index, int number, double value);
    void changePlanes(const QString& text, const std::function<void(std::vector<ClipPlane>&)>& change);

    Services& m_services;
    std::array<QLabel*, 3> m_axis{};
    std::array<std::array<QDoubleSpinBox*, 2>, 3> m_box{}; ///< [axis][lower, upper], per cent of the box
    std::array<PlaneRow, kMostClipPlanes> m_planes{};
    KnownHolder m_known;
    QLabel* m_holderLabel = named(new QLabel(tr("Board or holder"), this), "holderLabel");
    QDoubleSpinBox* m_holder = named(
        new QDoubleSpinBox(this), "holderDensity",
        tr("How strongly the board or holder under the object is drawn: 0 % leaves it out, 100 % draws and measures "
           "it like the rest. Below 100 % it is not measured, but still dims what lies behind it"));
    QPushButton* m_add =
        named(new QPushButton(tr("&Add plane"), this), "addPlaneButton",
              tr("Cut away what is nearer than the middle; at most %1 planes (Shift+C)").arg(kMostClipPlanes));
    QPushButton* m_reset =
        named(new QPushButton(tr("&Remove clipping"), this), "resetClipButton", tr("Cut nothing away"));
};

ClipPanel::ClipPanel(Services& services, QAction& handles, QWidget* parent) : QWidget(parent), m_services(services) {
    setObjectName("clipPanel");
    QVBoxLayout* const rows = columnOf({makeBox()}, 7);
    for (std::size_t i = 0; i < m_planes.size(); ++i) {
        m_planes[i] = makeRow(i);
        rows->addWidget(m_planes[i].widget);
    }
    rows->addLayout(rowOf({{m_add, 1}, {m_reset, 1}}));
    withLook(m_holder, {.hi = 100, .decimals = 1, .suffix = tr(" %")});
    rows->addLayout(rowOf({m_holderLabel, {m_holder, 1}}));
    auto* button = named(new QToolButton(this), "clipHandlesButton");
    button->setDefaultAction(&handles);
    rows->addWidget(button);
    rows->addStretch(1);
    fillScrolled(this, rows);

    connect(m_holder, &QDoubleSpinBox::valueChanged, this, [this](double percent) {
        const FaintRest known = m_known.of(m_services.scene());
        editPart(m_services.store(), &Session::clipping, tr("Board or holder"), QStringLiteral("clip-holder"),
                 [&](Clipping& c) {
                     c.rest = percent < 100 ? FaintRest{known.within, percent / 100} : FaintRest{};
                 });
    });
    connect(m_add, &QPushButton::clicked, this, [this, &handles] { addPlane(m_services, handles); });
    connect(m_reset, &QPushButton::clicked, this, [this] { clipNothing(m_services); });
    followParts(
        m_services, this, [this] { follow(); }, &Session::clipping);
}

QLayout* ClipPanel::makeBox() {
    auto* grid = new QGridLayout;
    grid->setHorizontalSpacing(6);
    grid->setColumnStretch(1, 1);
    grid->setColumnStretch(2, 1);
    for (int axis = 0; axis < 3; ++axis) {
        m_axis[static_cast<std::size_t>(axis)] =
            named(new QLabel(kAxes[axis]), QStringLiteral("clipAxis%1").arg(QString(kAxes[axis]).toUpper()));
        grid->addWidget(m_axis[static_cast<std::size_t>(axis)], axis, 0);
        for (int side = 0; side < 2; ++side) {
            auto* box =
                named(new QDoubleSpinBox,
                      QStringLiteral("clip%1%2").arg(QString(kAxes[axis]).toUpper(), side == 0 ? "Lo" : "Hi"), {});
            withLook(box, {.hi = 100, .decimals = 1, .suffix = tr(" %")});
            grid->addWidget(box, axis, side + 1);
            m_box[static_cast<std::size_t>(axis)][static_cast<std::size_t>(side)] = box;
            connect(box, &QDoubleSpinBox::valueChanged, this,
                    [this, axis, side](double percent) { editBox(axis, side == 1, percent); });
        }
        nameAxis(static_cast<std::size_t>(axis), {});
    }
    return grid;
}

ClipPanel::PlaneRow ClipPanel::makeRow(std::size_t index) {
    PlaneRow row{named(new QWidget, QStringLiteral("clipPlane%1").arg(index + 1)), {}};
    auto* grid = new QGridLayout(row.widget);
    grid->setContentsMargins(0, 0, 0, 0);
    grid->setHorizontalSpacing(4);
    grid->setVerticalSpacing(3);
    grid->addWidget(new QLabel(tr("Plane %1").arg(index + 1)), 0, 0);
    const char* const names[] = {"X", "Y", "Z", "D"};
    for (int number = 0; number < 4; ++number) {
        auto* box =
            named(new QDoubleSpinBox, QStringLiteral("clipPlane%1%2").arg(index + 1).arg(names[number]),
                  number < 3 ? tr("%1 of the plane's normal, which points to what is cut away").arg(kAxes[number])
                             : tr("Where the plane lies along its normal n, in the unit of the volume: points p with "
                                  "n·p at most this are left, as --clip NX,NY,NZ,D says it"));
        withLook(box, {-1e9, 1e9, 3, 0.05});
        // As wide as there is room, whatever the range.
        box->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);
        box->setMinimumWidth(60);
        row.boxes[static_cast<std::size_t>(number)] = box;
        grid->addWidget(box, number / 3, number % 3 + 1);
        connect(box, &QDoubleSpinBox::valueChanged, this,
                [this, index, number](double value) { editPlane(index, number, value); });
    }
    grid->addWidget(new QLabel(tr("Distance")), 1, 0);
    for (int column = 1; column < 4; ++column) grid->setColumnStretch(column, 1);
    auto* flip = named(toolButton(tr("Flip"), row.widget), QStringLiteral("flipPlane%1").arg(index + 1),
                       tr("Keep the other side of the plane"));
    auto* remove = named(toolButton(tr("Remove"), row.widget), QStringLiteral("removePlane%1").arg(index + 1),
                         tr("Take this clip plane away"));
    grid->addWidget(flip, 1, 2);
    grid->addWidget(remove, 1, 3);
    connect(flip, &QToolButton::clicked, this, [this, index] {
        changePlanes(tr("Flip plane"), [index](std::vector<ClipPlane>& planes) {
            planes.at(index) = {-planes.at(index).normal, -planes.at(index).offset};
        });
    });
    connect(remove, &QToolButton::clicked, this, [this, index] {
        changePlanes(tr("Remove plane"), [index](std::vector<ClipPlane>& planes) {
            planes.erase(planes.begin() + static_cast<std::ptrdiff_t>(index));
        });
    });
    return row;
}

void ClipPanel::changePlanes(const QString& text, const std::function<void(std::vector<ClipPlane>&)>& change) {
    editPart(m_services.store(), &Session::clipping, text, {}, [&](Clipping& c) { change(c.planes); });
}

/// By the patient's directions, where there is a patient: the grid may run against them.
void ClipPanel::nameAxis(std::size_t axis, const Geometry& geometry) {
    const QString name = kAxes[axis];
    QString tip =
        tr("The part of the box along %1 of its grid that is left, per cent of its length; picture and figures "
           "are of what is left")
            .arg(name);
    QString label = name;
    if (geometry.worldAxes == WorldAxes::Patient) {
        const QString run = QString::fromStdString(axisText(geometry, static_cast<int>(axis)));
        label = QStringLiteral("%1  %2").arg(name, run);
        tip += tr(". From 0 to 100 % it runs %1").arg(run);
    }
    m_axis[axis]->setText(label);
    for (QDoubleSpinBox* box : m_box[axis]) box->setToolTip(tip);
}

void ClipPanel::editBox(int axis, bool upper, double percent) {
    editPart(
        m_services.store(), &Session::clipping, tr("Clip"), QStringLiteral("clip-%1-%2").arg(axis).arg(upper),
        [&](Clipping& c) { c = withFaceMoved(c, axis, upper, percent / 100 - (upper ? c.hi : c.lo)[axis], false); });
}

void ClipPanel::editPlane(std::size_t index, int number, double value) {
    const std::vector<ClipPlane>& planes = m_services.scene().session.clipping->planes;
    if (index >= planes.size()) return;
    ClipPlane plane = planes[index];
    if (number < 3)
        plane.normal[number] = value;
    else
        plane.offset = value;
    if (!(glm::length(plane.normal) > 0)) return follow(); // no direction is left
    editPart(m_services.store(), &Session::clipping, tr("Clip plane"),
             QStringLiteral("clip-plane-%1-%2").arg(index).arg(number),
             [&](Clipping& c) { c.planes.at(index) = plane; });
}

void ClipPanel::follow() {
    const bool ready = m_services.isEditable();
    setEnabled(ready);
    const Scene& scene = m_services.scene();
    const Clipping& clipping = *scene.session.clipping;
    for (std::size_t i = 0; i < m_planes.size(); ++i) m_planes[i].widget->setVisible(i < clipping.planes.size());
    if (!m_services.store().hasVolume()) return;
    const Geometry& geometry = scene.volume->geometry();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const int a = static_cast<int>(axis);
        showNumber(*m_box[axis][0], 100 * clipping.lo[a]);
        showNumber(*m_box[axis][1], 100 * clipping.hi[a]);
        nameAxis(axis, geometry);
    }
    const bool liesOnSomething = !m_known.of(scene).isNone();
    m_holderLabel->setVisible(liesOnSomething);
    m_holder->setVisible(liesOnSomething);
    showNumber(*m_holder, clipping.rest.isNone() ? 100 : 100 * clipping.rest.density);
    const double size = 2 * geometry.radius();
    const bool hasUnit = unitOf(geometry) != LengthUnit::Unknown;
    const QString unit = hasUnit ? QStringLiteral(" ") + QString::fromUtf8(lengthUnit(geometry)) : QString();
    for (std::size_t i = 0; i < clipping.planes.size(); ++i) {
        const ClipPlane& plane = clipping.planes[i];
        for (int a = 0; a < 3; ++a) showNumber(*m_planes[i].boxes[static_cast<std::size_t>(a)], plane.normal[a]);
        QDoubleSpinBox& offset = *m_planes[i].boxes[3];
        const QSignalBlocker quiet(&offset); // other decimals are another number to it
        offset.setSuffix(unit);
        offset.setDecimals(decimalsFor(size));
        offset.setSingleStep(size / 100);
        showNumber(offset, plane.offset);
    }
    m_add->setEnabled(ready && clipping.planes.size() < kMostClipPlanes);
    m_reset->setEnabled(ready && !clipping.isNone());
}

QWidget* makePanel(Services& services, QAction& handles, QWidget* parent) {
    services.actions().add(
        QObject::tr("&View") + "/" + QObject::tr("Cl&ip"), "addPlaneAction", QObject::tr("Add clip p&lane"), "Shift+C",
        QObject::tr("Cut away what is nearer than the middle of the volume"),
        [&services, &handles] { addPlane(services, handles); },
        [&services] {
            return services.isEditable() && services.scene().session.clipping->planes.size() < kMostClipPlanes;
        });
    services.actions().add(
        QObject::tr("&View") + "/" + QObject::tr("Cl&ip"), "resetClipAction", QObject::tr("&Remove clipping"), {},
        QObject::tr("Cut nothing away"), [&services] { clipNothing(services); },
        [&services] { return services.isEditable() && !services.scene().session.clipping->isNone(); });
    return new ClipPanel(services, handles, parent);
}

} // namespace

PanelInfo clipPanel() {
    return {.id = "clip",
            .title = QObject::tr("Clip"),
            .visible = false,
            .tabOf = "display",
            .keys = QKeySequence("Ctrl+Shift+K"),
            .tip = QObject::tr("The part of the box that is left, oblique planes"),
            .make = [](Services& services, Controllers& controllers, QWidget* parent) {
                return makePanel(services, *controllers.clipHandles, parent);
            }};
}

} // namespace pellucid::gui
