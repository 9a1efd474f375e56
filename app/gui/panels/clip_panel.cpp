#include "panels/clip_panel.h"

#include <QDoubleSpinBox>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QToolButton>
#include <QVBoxLayout>

#include <glm/geometric.hpp>

#include "controllers/controllers.h"
#include "panels/panel.h"
#include "render/clip_handles.h"
#include "services/services.h"
#include "widgets/named.h"
#include "widgets/number_box.h"
#include "widgets/number_text.h"
#include "widgets/scrolled.h"

namespace pellucid::gui {
namespace {

constexpr const char* kAxes[] = {"x", "y", "z"};

bool isReady(Services& services) { return services.isEditable(); }

void addPlane(Services& services, QAction& handles) {
    const Scene& scene = services.scene();
    const ClipPlane plane = planeFacing(scene.camera, scene.volume->geometry());
    services.store().edit(QObject::tr("Clip plane"), {}, [&](Session& session) {
        session.clipping.edit([&](Clipping& c) { c.planes.push_back(plane); });
    });
    if (!handles.isChecked()) handles.trigger(); // it is there to be moved
}

} // namespace

ClipPanel::ClipPanel(Services& services, QAction& handles, QWidget* parent)
    : QWidget(parent), m_services(services), m_add(new QPushButton(tr("&Add plane"), this)),
      m_reset(new QPushButton(tr("&Whole box"), this)) {
    setObjectName("clipPanel");
    named(m_add, "addPlaneButton",
          tr("Cut away what is nearer than the middle; at most %1 planes (Shift+C)").arg(kMostClipPlanes));
    named(m_reset, "resetClipButton", tr("Cut nothing away"));
    auto* button = new QToolButton(this);
    button->setObjectName("clipHandlesButton");
    button->setDefaultAction(&handles);

    auto* content = new QWidget;
    auto* rows = new QVBoxLayout(content);
    rows->setContentsMargins(10, 8, 10, 8);
    rows->setSpacing(7);
    rows->addWidget(makeBox());
    for (std::size_t i = 0; i < m_planes.size(); ++i) {
        m_planes[i] = makeRow(i);
        rows->addWidget(m_planes[i].widget);
    }
    auto* buttons = new QHBoxLayout;
    buttons->addWidget(m_add, 1);
    buttons->addWidget(m_reset, 1);
    rows->addLayout(buttons);
    rows->addWidget(button);
    rows->addStretch(1);
    fillScrolled(this, content);

    connect(m_add, &QPushButton::clicked, this, [this, &handles] { addPlane(m_services, handles); });
    connect(m_reset, &QPushButton::clicked, this, [this] {
        m_services.store().edit(tr("Whole box"), {}, [](Session& session) { session.clipping.set({}); });
    });
    connect(&m_services.store(), &SessionStore::changed, this, [this](const Scene& before, const Scene& after) {
        if (before.volume != after.volume || !before.session.clipping.isSame(after.session.clipping)) follow();
    });
    connect(&m_services, &Services::readOnlyChanged, this, &ClipPanel::follow);
    follow();
}

QWidget* ClipPanel::makeBox() {
    auto* widget = new QWidget;
    auto* grid = new QGridLayout(widget);
    grid->setContentsMargins(0, 0, 0, 0);
    grid->setHorizontalSpacing(6);
    grid->setColumnStretch(1, 1);
    grid->setColumnStretch(2, 1);
    for (int axis = 0; axis < 3; ++axis) {
        grid->addWidget(new QLabel(kAxes[axis]), axis, 0);
        for (int side = 0; side < 2; ++side) {
            auto* box = new QDoubleSpinBox;
            box->setObjectName(QStringLiteral("clip%1%2").arg(QString(kAxes[axis]).toUpper(), side == 0 ? "Lo" : "Hi"));
            box->setRange(0, 100);
            box->setDecimals(1);
            box->setSuffix(tr(" %"));
            box->setKeyboardTracking(false);
            box->setToolTip(tr("The part of the box along %1 of its grid that is left, per cent of its length; picture "
                               "and figures are of what is left")
                                .arg(kAxes[axis]));
            grid->addWidget(box, axis, side + 1);
            m_box[static_cast<std::size_t>(axis)][static_cast<std::size_t>(side)] = box;
            connect(box, &QDoubleSpinBox::valueChanged, this,
                    [this, axis, side](double percent) { editBox(axis, side == 1, percent); });
        }
    }
    return widget;
}

ClipPanel::PlaneRow ClipPanel::makeRow(std::size_t index) {
    PlaneRow row{new QWidget, {}};
    row.widget->setObjectName(QStringLiteral("clipPlane%1").arg(index + 1));
    auto* grid = new QGridLayout(row.widget);
    grid->setContentsMargins(0, 0, 0, 0);
    grid->setHorizontalSpacing(6);
    grid->setVerticalSpacing(3);
    grid->addWidget(new QLabel(tr("Plane %1").arg(index + 1)), 0, 0);
    const char* const names[] = {"X", "Y", "Z", "D"};
    for (int number = 0; number < 4; ++number) {
        auto* box = new QDoubleSpinBox;
        box->setObjectName(QStringLiteral("clipPlane%1%2").arg(index + 1).arg(names[number]));
        box->setRange(-1e9, 1e9);
        box->setDecimals(3);
        box->setSingleStep(0.05);
        box->setKeyboardTracking(false);
        box->setToolTip(number < 3 ? tr("%1 of the plane's normal, which points to what is cut away").arg(kAxes[number])
                                   : tr("Where the plane lies along its normal n, in world units: points p with "
                                        "n·p at most this are left, as --clip NX,NY,NZ,D says it"));
        // As wide as there is room, whatever the range.
        box->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);
        box->setMinimumWidth(64);
        row.boxes[static_cast<std::size_t>(number)] = box;
        if (number < 3)
            grid->addWidget(box, 0, number + 1);
        else
            grid->addWidget(box, 1, 1);
        connect(box, &QDoubleSpinBox::valueChanged, this,
                [this, index, number](double value) { editPlane(index, number, value); });
    }
    auto* distance = new QLabel(tr("Distance"));
    grid->addWidget(distance, 1, 0);
    for (int column = 1; column < 4; ++column) grid->setColumnStretch(column, 1);
    auto* flip = new QPushButton(tr("Flip"));
    named(flip, QStringLiteral("flipPlane%1").arg(index + 1), tr("Keep the other side"));
    auto* remove = new QPushButton(tr("Remove"));
    remove->setObjectName(QStringLiteral("removePlane%1").arg(index + 1));
    grid->addWidget(flip, 1, 2);
    grid->addWidget(remove, 1, 3);
    connect(flip, &QPushButton::clicked, this, [this, index] {
        changePlanes(tr("Flip plane"), [index](std::vector<ClipPlane>& planes) {
            planes.at(index) = {-planes.at(index).normal, -planes.at(index).offset};
        });
    });
    connect(remove, &QPushButton::clicked, this, [this, index] {
        changePlanes(tr("Remove plane"), [index](std::vector<ClipPlane>& planes) {
            planes.erase(planes.begin() + static_cast<std::ptrdiff_t>(index));
        });
    });
    return row;
}

void ClipPanel::changePlanes(const QString& text, const std::function<void(std::vector<ClipPlane>&)>& change) {
    m_services.store().edit(text, {},
                            [&](Session& session) { session.clipping.edit([&](Clipping& c) { change(c.planes); }); });
}

void ClipPanel::editBox(int axis, bool upper, double percent) {
    m_services.store().edit(tr("Clip"), QStringLiteral("clip-%1-%2").arg(axis).arg(upper), [&](Session& session) {
        session.clipping.edit([&](Clipping& c) {
            c = withFaceMoved(c, axis, upper, percent / 100 - (upper ? c.hi : c.lo)[axis], false);
        });
    });
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
    m_services.store().edit(
        tr("Clip plane"), QStringLiteral("clip-plane-%1-%2").arg(index).arg(number),
        [&](Session& session) { session.clipping.edit([&](Clipping& c) { c.planes.at(index) = plane; }); });
}

QSize ClipPanel::sizeHint() const { return findChild<QScrollArea*>()->widget()->sizeHint() + QSize(24, 4); }

void ClipPanel::follow() {
    const bool ready = isReady(m_services);
    setEnabled(ready);
    const Scene& scene = m_services.scene();
    const Clipping& clipping = *scene.session.clipping;
    for (std::size_t i = 0; i < m_planes.size(); ++i) m_planes[i].widget->setVisible(i < clipping.planes.size());
    if (!m_services.store().hasVolume()) return;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const int a = static_cast<int>(axis);
        showNumber(*m_box[axis][0], 100 * clipping.lo[a]);
        showNumber(*m_box[axis][1], 100 * clipping.hi[a]);
    }
    const Geometry& geometry = scene.volume->geometry();
    const double size = 2 * geometry.radius();
    const QString unit = geometry.frame == Frame::Patient ? tr(" mm") : QString();
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

PanelInfo clipPanel() {
    return {.id = "clip",
            .title = QObject::tr("Clip"),
            .area = Qt::RightDockWidgetArea,
            .visible = false,
            .tabOf = "display",
            .keys = QKeySequence("Ctrl+K"),
            .tip = QObject::tr("The part of the box that is left, oblique planes"),
            .make = [](Services& services, Controllers& controllers, QWidget* parent) {
                services.actions().add(
                    QObject::tr("&View"), "addPlaneAction", QObject::tr("Add clip p&lane"), "Shift+C",
                    QObject::tr("Cut away what is nearer than the middle of the volume"),
                    [&services, &handles = *controllers.clipHandles] { addPlane(services, handles); },
                    [&services] {
                        return isReady(services) && services.scene().session.clipping->planes.size() < kMostClipPlanes;
                    });
                services.actions().add(
                    QObject::tr("&View"), "resetClipAction", QObject::tr("&Whole box"), {},
                    QObject::tr("Cut nothing away"),
                    [&services] {
                        services.store().edit(QObject::tr("Whole box"), {},
                                              [](Session& session) { session.clipping.set({}); });
                    },
                    [&services] { return isReady(services) && !services.scene().session.clipping->isNone(); });
                QObject::connect(&services.store(), &SessionStore::changed, &services.actions(),
                                 [&services](const Scene& before, const Scene& after) {
                                     const Clipping &old = *before.session.clipping, &now = *after.session.clipping;
                                     if (old.isNone() != now.isNone() || old.planes.size() != now.planes.size())
                                         services.actions().refresh();
                                 });
                return new ClipPanel(services, *controllers.clipHandles, parent);
            }};
}

} // namespace pellucid::gui
