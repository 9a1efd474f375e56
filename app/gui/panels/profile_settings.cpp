#include "panels/profile_settings.h"

#include <QComboBox>
#include <QGridLayout>
#include <QLabel>
#include <QPushButton>

#include "render/published_engine.h"
#include "services/services.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

/// Whether the picture shows what the figures are of, but for its size.
bool looksAlong(const Camera& camera, const Geometry& geometry, Along along) {
    const Vec3 off = camera.forward() - cameraAlong(geometry, along).forward();
    return camera.projection == Projection::Orthographic && dot(off, off) < 1e-12;
}

} // namespace

ProfileSettings::ProfileSettings(Services& services, QWidget* parent)
    : QWidget(parent), m_services(services), m_profile(new QComboBox(this)), m_along(new QComboBox(this)),
      m_remark(new QLabel(this)), m_look(new QPushButton(tr("Look &there"), this)) {
    m_profile->setObjectName("profileCombo");
    m_profile->addItem(tr("Pellucid's"), static_cast<int>(Profile::Default));
    m_profile->addItem(tr("Published"), static_cast<int>(Profile::Published));
    m_profile->setToolTip(
        tr("Definitions of visibility, saliency and VWS. Published: those of the programs behind the\n"
           "thesis's printed numbers, with 8-bit opacities and no camera, for comparing with them"));
    m_along->setObjectName("alongCombo");
    const std::pair<Along, QString> faces[] = {{Along::Front, tr("front")}, {Along::Back, tr("back")},
                                               {Along::Left, tr("left")},   {Along::Right, tr("right")},
                                               {Along::Top, tr("top")},     {Along::Bottom, tr("bottom")}};
    for (const auto& [along, text] : faces) m_along->addItem(text, static_cast<int>(along));
    m_along->setToolTip(tr("The face of the grid that published figures look at: front is that of the highest y,\n"
                           "top that of the highest z, right that of the highest x"));
    m_remark->setObjectName("profileRemark");
    m_remark->setWordWrap(true);
    m_remark->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
    makeFaint(*m_remark);
    m_look->setObjectName("lookAlongButton");
    m_look->setAutoDefault(false);
    m_look->setToolTip(tr("Turn the picture to what the figures are of, in parallel projection"));

    auto* grid = new QGridLayout(this);
    grid->setContentsMargins(10, 0, 10, 0);
    grid->setHorizontalSpacing(8);
    grid->setVerticalSpacing(4);
    auto* label = new QLabel(tr("&Definitions"), this);
    label->setBuddy(m_profile);
    grid->addWidget(label, 0, 0);
    grid->addWidget(m_profile, 0, 1);
    grid->addWidget(m_along, 0, 2);
    grid->addWidget(m_remark, 1, 0, 1, 2);
    grid->addWidget(m_look, 1, 2);
    grid->setColumnStretch(1, 1);

    connect(m_profile, &QComboBox::activated, this, &ProfileSettings::edit);
    connect(m_along, &QComboBox::activated, this, &ProfileSettings::edit);
    connect(m_look, &QPushButton::clicked, this, &ProfileSettings::lookAlong);
    connect(&m_services.store(), &SessionStore::changed, this, &ProfileSettings::follow);
    connect(&m_services.store(), &SessionStore::historyChanged, this, &ProfileSettings::follow);
    follow();
}

void ProfileSettings::edit() {
    const auto profile = static_cast<Profile>(m_profile->currentData().toInt());
    const auto along = static_cast<Along>(m_along->currentData().toInt());
    m_services.store().edit(tr("Definitions of figures"), "profile", [&](Session& session) {
        session.measure.edit([&](MeasureSettings& m) {
            m.profile = profile;
            m.along = along;
        });
    });
}

void ProfileSettings::lookAlong() {
    const Scene& scene = m_services.scene();
    m_services.store().setCamera(cameraAlong(scene.volume->geometry(), scene.session.measure->along));
}

void ProfileSettings::follow() {
    const Scene& scene = m_services.scene();
    const MeasureSettings& settings = *scene.session.measure;
    const bool published = settings.profile == Profile::Published;
    m_profile->setCurrentIndex(m_profile->findData(static_cast<int>(settings.profile)));
    m_along->setCurrentIndex(m_along->findData(static_cast<int>(settings.along)));
    m_along->setVisible(published);
    setEnabled(m_services.isEditable());
    const bool elsewhere =
        published && scene.volume && !looksAlong(scene.camera, scene.volume->geometry(), settings.along);
    m_remark->setText(tr("Figures are of the %1 of the grid, not of this view.").arg(m_along->currentText()));
    m_remark->setVisible(elsewhere);
    m_look->setVisible(elsewhere);
}

} // namespace pellucid::gui
