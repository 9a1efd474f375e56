// The panel of 2D feature saliency: whether the picture is looked at, and what lies over it.
#include <QPushButton>

#include "controllers/controllers.h"
#include "panels/panel.h"
#include "panels/panel_parts.h"
#include "panels/setting_rows.h"
#include "widgets/controls.h"
#include "widgets/layouts.h"
#include "widgets/terms.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

class PictureSaliencyPanel : public QWidget {
public:
    PictureSaliencyPanel(Services& services, PictureSaliencyController& saliency, QWidget* parent);

    QSize sizeHint() const override { return sizeWithoutScrolling(*this); }

private:
    void follow();
    QString stateText() const;

    Services& m_services;
    PictureSaliencyController& m_saliency;
    QLabel* m_shares = wrappedLabel("pictureSaliencyShares", this);
    QLabel* m_state = wrappedLabel("pictureSaliencyState", this);
    QProgressBar* m_progress = progressBar("pictureSaliencyProgress", this);
    QPushButton* m_save =
        named(new QPushButton(tr("Sa&ve map…"), this), "pictureSaliencySave",
              tr("Write the map that lies over the picture, else that of the whole picture, as OpenEXR or PNG"));
};

PictureSaliencyPanel::PictureSaliencyPanel(Services& services, PictureSaliencyController& saliency, QWidget* parent)
    : QWidget(parent), m_services(services), m_saliency(saliency) {
    setObjectName("pictureSaliencyPanel");
    makeFaint(*m_state);
    m_progress->setMaximumHeight(6);
    QFormLayout& form = *scrolledForm(this, 7);
    auto* rows = new SettingRows(m_services, form, settingPart<PictureSaliencyView>(&Session::pictureSaliency));
    rows->add("on", {.id = "pictureSaliencyCheck"});
    rows->add("map", {.id = "pictureSaliencyMap"});
    rows->add("strength", percentLook("pictureSaliencyStrength"));
    rows->follow();
    form.addRow(m_shares);
    form.addRow(m_state);
    form.addRow(m_progress);
    form.addRow(m_save);
    connect(m_save, &QPushButton::clicked, this, [this] { m_saliency.chooseFile(); });
    connect(&m_saliency, &PictureSaliencyController::changed, this, &PictureSaliencyPanel::follow);
    connect(&terms(), &Terms::changed, this, &PictureSaliencyPanel::follow);
    follow();
}

QString PictureSaliencyPanel::stateText() const {
    using State = PictureSaliencyController::State;
    switch (m_saliency.state()) {
    case State::Off:
        return tr("How much of what catches the eye in this picture belongs to each feature. \"%1\" says the same of "
                  "the volume.")
            .arg(terms().attention());
    case State::Field:
        return tr("A field is drawn, and has no features. Switch it off to look at the picture of the data.");
    case State::Computing:
        return tr("The picture and those of its features are being drawn.");
    case State::Current: {
        const RenderSettings& s = m_saliency.picture().settings;
        return tr("Of this picture, %1 × %2 pixels, %3")
            .arg(s.width)
            .arg(s.height)
            .arg(s.light.on ? tr("lit") : tr("not lit"));
    }
    case State::Failed:
        return QString::fromUtf8(m_saliency.failure()->what());
    }
    return {};
}

void PictureSaliencyPanel::follow() {
    using State = PictureSaliencyController::State;
    QStringList lines;
    const std::vector<Feature>& features = m_services.scene().tf.features;
    for (std::size_t f = 0; f < features.size(); ++f)
        if (const std::optional<double> share = m_saliency.share(f))
            lines += tr("%1: %2 %").arg(QString::fromStdString(features[f].name)).arg(100 * *share, 0, 'f', 1);
    m_shares->setText(lines.join('\n'));
    m_shares->setVisible(!lines.isEmpty());
    m_shares->setEnabled(m_saliency.state() == State::Current);
    m_state->setText(stateText());
    m_progress->setVisible(m_saliency.state() == State::Computing);
    m_progress->setValue(static_cast<int>(100 * m_saliency.progress()));
    m_save->setEnabled(m_saliency.state() == State::Current);
}

} // namespace

PanelInfo pictureSaliencyPanel() {
    return {.id = "pictureSaliency",
            .title = QObject::tr("2D saliency"),
            .group = PanelGroup::Shares,
            .visible = false,
            .tabOf = "display",
            .keys = QKeySequence("Ctrl+Alt+D"),
            .tip = QObject::tr("What catches the eye in the picture, and how much of that each feature has"),
            .make = [](Services& services, Controllers& controllers, QWidget* parent) {
                return new PictureSaliencyPanel(services, controllers.pictureSaliency, parent);
            }};
}

} // namespace pellucid::gui
