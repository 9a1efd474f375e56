// The panel of the overlay: its file, which of its values are drawn, and how.
#include <QCheckBox>
#include <QPushButton>

#include "controllers/controllers.h"
#include "dialogs/series_files.h"
#include "engines/engines.h"
#include "panels/panel.h"
#include "panels/panel_parts.h"
#include "panels/setting_rows.h"
#include "render/picture_shares.h"
#include "widgets/controls.h"
#include "widgets/elided.h"
#include "widgets/layouts.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

class OverlayPanel : public QWidget {
public:
    OverlayPanel(Services& services, OverlayController& overlays, QWidget* parent);

    QSize sizeHint() const override { return sizeWithoutScrolling(*this); }

private:
    void addRows(QFormLayout& form);
    void follow();
    QString stateText() const;
    void computeShares();
    QString sharesText() const;

    Services& m_services;
    OverlayController& m_overlays;
    QCheckBox* m_shown = named(new QCheckBox(tr("&Overlay"), this), "overlayShown",
                               tr("Draw the second volume over the first; figures do not depend on it"));
    QLabel* m_file = withAnyWidth(named(new ElidedLabel(this), "overlayFile"));
    QPushButton* m_choose = named(new QPushButton(tr("Choose…"), this), "overlayChoose",
                                  tr("A second volume over this one, where both lie in the world"));
    QPushButton* m_remove =
        named(new QPushButton(tr("Remove"), this), "overlayRemove", tr("Draw this volume alone again"));
    QComboBox* m_colorMap = named(new QComboBox(this), "overlayColorMap",
                                  tr("Colours from 0 to the top; a diverging map from −top to top of both signs"));
    QLabel* m_curve = withAnyWidth(named(new QLabel(this), "overlayCurve"));
    QPushButton* m_openCurve = named(new QPushButton(tr("Open…"), this), "overlayOpenCurve",
                                     tr("A transfer function from a file, in the place of threshold, top and colours"));
    QPushButton* m_removeCurve =
        named(new QPushButton(tr("None"), this), "overlayRemoveCurve", tr("By threshold, top and colours again"));
    QPushButton* m_computeShares =
        named(new QPushButton(tr("Shares of both"), this), "overlayComputeShares",
              tr("What part of the picture's opacity the overlay and each feature have, in per cent; whatever lies in "
                 "front hides what lies behind, of either volume"));
    QLabel* m_state = wrappedLabel("overlayState", this);
    QLabel* m_sharesText = wrappedLabel("overlayShares", this);
    std::optional<PictureShares> m_shares; ///< of m_sharesOf
    PictureInput m_sharesOf;
    Job<PictureInput, PictureShares> m_job;
    SettingRows* m_rows = nullptr;
};

/// The picture as it is seen, with fewer pixels: shares are means over all of them.
PictureInput sharedPicture(const Scene& scene) {
    constexpr int kWidth = 320, kHeight = 240;
    PictureInput picture = pictureInput(scene, kWidth, kHeight, true);
    picture.settings.finestInD0.reset();
    return picture;
}

OverlayPanel::OverlayPanel(Services& services, OverlayController& overlays, QWidget* parent)
    : QWidget(parent), m_services(services), m_overlays(overlays),
      m_job(
          [](const PictureInput& picture, const JobControl& job) {
              const auto renderer = makeRenderer(EngineChoice::Cpu, picture.volume);
              return pictureShares(*renderer, picture.camera, picture.tf, picture.settings, job);
          },
          [this](const PictureInput& picture, PictureShares& shares) {
              m_sharesOf = picture;
              m_shares = std::move(shares);
              follow();
          }) {
    setObjectName("overlayPanel");
    m_file->setTextFormat(Qt::PlainText);
    makeFaint(*m_state);
    addItem(*m_colorMap, tr("automatic"), QString::fromLatin1(OverlayView::kAutomatic),
            tr("Blue to red of both signs, else ember"));
    addColorMaps(*m_colorMap);
    addRows(*scrolledForm(this, 6));

    connect(m_shown, &QCheckBox::clicked, this, [this](bool shown) {
        m_overlays.setShown(shown);
        m_shown->setChecked(m_services.store().session().overlay->isDrawn()); // until it has been done
    });
    connect(m_computeShares, &QPushButton::clicked, this, [this] { computeShares(); });
    connect(&m_job, &JobBase::busyChanged, this, [this] { follow(); });
    services.showFailuresOf(m_job, tr("Cannot tell the shares"));
    connect(m_choose, &QPushButton::clicked, this, [this] { m_overlays.choose(); });
    connect(m_remove, &QPushButton::clicked, this, [this] { m_overlays.remove(); });
    connect(m_openCurve, &QPushButton::clicked, this, [this] { m_overlays.chooseCurve(); });
    connect(m_removeCurve, &QPushButton::clicked, this, [this] { m_overlays.removeCurve(); });
    connect(m_colorMap, &QComboBox::activated, this, [this] {
        const std::string name = m_colorMap->currentData().toString().toStdString();
        editPart(m_services.store(), &Session::overlay, tr("Colours of the overlay"), {},
                 [name](OverlayView& o) { o.colorMap = name; });
    });
    connect(&m_services.store(), &SessionStore::changed, this, [this](const Scene& before, const Scene& after) {
        if (m_shares) follow();
        if (before.overlay == after.overlay) return;
        m_rows->follow(); // what "auto" stands for
        follow();
    });
    followParts(
        m_services, this, [this] { follow(); }, &Session::overlay);
}

void OverlayPanel::addRows(QFormLayout& form) {
    form.addRow(rowOf({m_shown, {m_file, 1}}));
    form.addRow(rowOf({m_choose, m_remove, Cell::rest()}));
    m_rows = new SettingRows(m_services, form, settingPart<OverlayView>(&Session::overlay));
    const auto found = [this](double OverlayLook::*member) {
        return [this, member] {
            const auto& overlay = m_services.scene().overlay;
            return overlay ? overlay->look.*member : 0.0;
        };
    };
    m_rows->add("sides", {.id = "overlaySides", .stepText = tr("Sides of the overlay")});
    m_rows->add("threshold", {.id = "overlayThreshold",
                              .decimals = 4,
                              .step = 0.1,
                              .automatic = found(&OverlayLook::threshold),
                              .stepText = tr("Threshold of the overlay")});
    m_rows->add("top", {.id = "overlayTop",
                        .decimals = 4,
                        .step = 0.1,
                        .automatic = found(&OverlayLook::top),
                        .stepText = tr("Top of the overlay")});
    form.addRow(tr("&Colours"), m_colorMap);
    m_rows->add("opacity", {.id = "overlayOpacity",
                            .slider = true,
                            .logarithmic = true,
                            .decimals = 3,
                            .step = 0.01,
                            .least = 0.001,
                            .automatic = [] { return OverlayView::kUsual; },
                            .stepText = tr("Opacity of the overlay")});
    form.addRow(tr("Own curve"), rowOf({{m_curve, 1}, m_openCurve, m_removeCurve}));
    form.addRow(rowOf({m_computeShares, Cell::rest()}));
    form.addRow(m_sharesText);
    form.addRow(m_state);
    m_rows->follow();
}

void OverlayPanel::computeShares() {
    m_shares.reset();
    m_job.start(sharedPicture(m_services.scene()), tr("the shares of the picture"));
}

QString OverlayPanel::sharesText() const {
    if (m_job.isRunning()) return tr("Drawing…");
    if (!m_shares || !(m_sharesOf == sharedPicture(m_services.scene()))) return {};
    const auto percent = [this](double share) { // of all that is seen
        return tr("%1 %").arg(100 * share / std::max(m_shares->alpha, 1e-9), 0, 'f', 1);
    };
    QStringList parts{tr("overlay %1").arg(percent(m_shares->overlay))};
    for (std::size_t f = 0; f < m_shares->features.size(); ++f)
        parts << QString::fromStdString(m_sharesOf.tf.features[f].name) + ' ' + percent(m_shares->features[f]);
    if (m_shares->rest > 0.001 * m_shares->alpha) parts << tr("other values %1").arg(percent(m_shares->rest));
    return tr("Seen in the picture: %1.").arg(parts.join(", "));
}

QString OverlayPanel::stateText() const {
    const Scene& scene = m_services.scene();
    const OverlayView& view = *scene.session.overlay;
    if (view.isNone())
        return tr("A second volume over this one, such as a t-map on its anatomy or a dose on its CT, with colours of "
                  "its own.");
    QStringList lines{tr("Figures in the panel Features are of the volume alone: the overlay hides nothing in them.")};
    if (scene.overlay) {
        const ValueRange& values = scene.overlay->volume->dataRange();
        lines.prepend(tr("Values %1 to %2.").arg(values.lo, 0, 'g', 4).arg(values.hi, 0, 'g', 4));
        if (scene.overlay->byCentres)
            lines << tr("Nothing tells where both lie in one world: the centres of their boxes are one.");
    }
    if (scene.session.display->mode != RenderMode::Composite)
        lines << tr("In this way to draw the overlay lies in front of everything; Composite draws it in its place.");
    return lines.join('\n');
}

void OverlayPanel::follow() {
    setEnabled(m_services.isEditable());
    if (!m_services.store().hasVolume()) return;
    const OverlayView& view = *m_services.scene().session.overlay;
    const bool any = !view.isNone();
    m_file->setText(any ? titleOf(view.source) : tr("none"));
    m_file->setToolTip(QString::fromStdString(view.source.path));
    m_shown->setChecked(view.isDrawn());
    m_colorMap->setCurrentIndex(m_colorMap->findData(QString::fromStdString(view.colorMap)));
    m_curve->setText(view.curve ? tr("from a file") : tr("none"));
    for (QWidget* widget : std::initializer_list<QWidget*>{m_shown, m_remove}) widget->setEnabled(any);
    m_colorMap->setEnabled(view.isDrawn() && !view.curve);
    m_openCurve->setEnabled(view.isDrawn());
    m_removeCurve->setEnabled(view.isDrawn() && view.curve);
    m_computeShares->setEnabled(view.isDrawn() && !m_job.isRunning());
    const QString shares = sharesText();
    m_sharesText->setText(shares);
    m_sharesText->setVisible(!shares.isEmpty());
    m_state->setText(stateText());
}

} // namespace

PanelInfo overlayPanel() {
    return {.id = "overlay",
            .title = QObject::tr("Overlay"),
            .visible = false,
            .tabOf = "display",
            .keys = QKeySequence("Ctrl+Alt+V"),
            .tip = QObject::tr("A second volume over the first, with colours of its own"),
            .make = [](Services& services, Controllers& controllers, QWidget* parent) {
                return new OverlayPanel(services, controllers.overlays, parent);
            }};
}

} // namespace pellucid::gui
