#include "panels/channels_box.h"

#include <algorithm>
#include <cmath>

#include "controllers/open_controller.h"
#include "panels/panel_parts.h"
#include "panels/setting_rows.h"
#include "panels/variable_words.h"
#include "widgets/layouts.h"
#include "widgets/number_box.h"

namespace pellucid::gui {
namespace {

constexpr double kLeastScale = 0.1, kMostScale = 1000; ///< of sliders
constexpr int kMostFrames = 2048;
/// Voxels of which colours are made while the hand moves: some 40 ms.
constexpr std::size_t kFastVoxels = std::size_t{4} << 20;
constexpr Channel kChannels[] = {Channel::Opacity, Channel::Saturation, Channel::Brightness, Channel::Hue};

std::size_t indexOf(Channel channel) { return static_cast<std::size_t>(channel); }

SessionStore::Change hueChange(bool to, double degrees) {
    return changing(&Session::hsb, [=](HsbMapping& h) { (to ? h.hueTo : h.hueFrom) = degrees; });
}

/// By Channel.
const std::array kTitles{QT_TR_NOOP("Opacity"), QT_TR_NOOP("Saturation"), QT_TR_NOOP("Brightness"), QT_TR_NOOP("Hue")};

} // namespace

ChannelsBox::ChannelsBox(Services& services, OpenController& opening, QWidget* parent)
    : QWidget(parent), m_services(services), m_opening(opening) {
    setObjectName("channelsBox");
    auto* form = narrowForm(new QFormLayout);
    form->setVerticalSpacing(6);
    // Below the form, not in it: of wrapped rows Qt takes the height of the last one for that of a hidden one after it.
    setLayout(inset(columnOf({form, m_note}, 6), {}));
    for (QSpinBox* box : {m_featureFrames, m_frames}) {
        box->setRange(1, kMostFrames);
        box->setKeyboardTracking(false);
        box->setPrefix(tr("n = "));
        box->setSuffix(tr(" frames"));
    }
    addFeatures(*form);
    form->addRow(m_on);
    addChannel(*form, Channel::Saturation, "hsbSaturation", tr("Saturation ←"),
               tr("Saturation = clip(a · std): what changes over time is colourful, what rests is grey"));
    form->addRow(QString(), m_frames);
    auto* scales = new SettingRows(m_services, *form, settingPart<HsbMapping>(&Session::hsb));
    scales->setCommit([this](const QString& text, const QString& key, const auto& change) { edit(text, key, change); });
    scales->setPreview([this](const QString& text, const auto& change) { preview(text, change); },
                       [this] { return isFast(); });
    const auto addScale = [&](const char* key, const QString& id, double Scene::*present, const QString& stepText) {
        scales->add(key, {.id = id,
                          .slider = true,
                          .logarithmic = true,
                          .decimals = 3,
                          .least = kLeastScale,
                          .most = kMostScale,
                          .automatic = [this, present] { return m_services.scene().*present; },
                          .stepText = stepText});
    };
    addScale("a", "hsbA", &Scene::hsbA, tr("Scale of saturation"));
    addChannel(*form, Channel::Brightness, "hsbBrightness", tr("Brightness ←"),
               tr("Brightness = 1 − clip(b · Y): the more of it, the darker"));
    addScale("b", "hsbB", &Scene::hsbB, tr("Scale of darkness"));
    form->addRow(QString(), m_swap);
    addChannel(*form, Channel::Hue, "hsbHue", tr("Hue ←"), tr("One hue for all, or one for each value of a variable"));
    addHue(*form);

    connect(m_on, &QCheckBox::clicked, this, &ChannelsBox::setOn);
    connect(m_frames, &QSpinBox::valueChanged, this, [this](int frames) {
        m_opening.editInJob(tr("Frames of volatility"),
                            [frames](Session& session) { setVolatilityFrames(session, frames); });
    });
    connect(m_swap, &QPushButton::clicked, this,
            [this] { m_opening.editInJob(tr("Swap variables"), [](Session& s) { swapOpacityAndBrightness(s); }); });
    connect(&m_services.store(), &SessionStore::changed, this, [=, this](const Scene& before, const Scene& after) {
        if (before.colors == after.colors) return;
        scales->follow(); // what "auto" stands for
        follow();
    });
    scales->follow();
    followParts(
        m_services, this, [this] { follow(); }, &Session::variables, &Session::hsb);
}

void ChannelsBox::addFeatures(QFormLayout& form) {
    addChannel(form, Channel::Opacity, "featuresOf", tr("Features of"),
               tr("The variable whose curve, histogram and features are shown, and that drives opacity: alpha =\n"
                  "transfer function of X. Figures, targets, refinement and optimization are of it. Each variable\n"
                  "keeps a transfer function of its own."));
    form.addRow(QString(), m_featureFrames);
    connect(m_featureFrames, &QSpinBox::valueChanged, this, [this](int frames) {
        m_opening.editInJob(tr("Frames of the features' volatility"),
                            [frames](Session& session) { setFeatureFrames(session, frames); });
    });
}

void ChannelsBox::addChannel(QFormLayout& form, Channel channel, const char* name, const QString& label,
                             const QString& tip) {
    auto* combo = named(new QComboBox(this), name, tip);
    combo->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    combo->setMinimumContentsLength(8);
    m_channels[indexOf(channel)] = combo;
    form.addRow(label, combo);
    connect(combo, &QComboBox::activated, this, [this, combo, channel] {
        const std::string driver = combo->currentData().toString().toStdString();
        if (driver == channelOf(m_services.store().session(), channel)) return;
        if (channel == Channel::Opacity)
            return m_opening.editInJob(tr("Features of %1").arg(combo->currentText()),
                                       [driver](Session& s) { setFeaturesOf(s, driver); });
        m_opening.editInJob(tr("%1 from %2").arg(tr(kTitles[indexOf(channel)]), combo->currentText()),
                            [channel, driver](Session& s) { setChannel(s, channel, driver); });
    });
}

void ChannelsBox::addHue(QFormLayout& form) {
    m_hueSlider->setRange(0, 359);
    m_hueSlider->setMinimumWidth(40);
    for (QDoubleSpinBox* box : {m_hueFrom, m_hueTo}) {
        const Setting& setting = settingOf(settingsOf<HsbMapping>(), box == m_hueTo ? "hue_to" : "hue_from");
        withLook(box, {.lo = setting.range.lo, .hi = setting.range.hi, .step = 10, .suffix = setting.unit});
        connect(box, &QDoubleSpinBox::valueChanged, this,
                [=, this](double value) { edit(tr("Hue"), box->objectName(), hueChange(box == m_hueTo, value)); });
    }
    m_hueTo->setPrefix(tr("to "));
    form.addRow(QString(), rowOf({m_hueSwatch, {m_hueSlider, 1}, m_hueFrom, m_hueTo}));
    connect(m_hueSlider, &QSlider::valueChanged, this, &ChannelsBox::slideHue);
    connect(m_hueSlider, &QSlider::sliderReleased, this, [this] {
        if (isFast()) return m_services.store().commit();
        edit(tr("Hue"), {}, hueChange(false, m_hueSlider->value()));
    });
}

/// While the hand moves the picture follows, where making colours is fast enough for that.
void ChannelsBox::slideHue(int hue) {
    if (!m_hueSlider->isSliderDown()) return edit(tr("Hue"), m_hueSlider->objectName(), hueChange(false, hue));
    if (isFast()) preview(tr("Hue"), hueChange(false, hue));
}

void ChannelsBox::toggle() { setOn(!m_services.store().session().hsb->on); }

void ChannelsBox::setOn(bool on) {
    const bool varies = m_services.scene().series && m_services.scene().series->varies();
    const auto change = [on, varies](Session& session) {
        if (on) startMapping(session, varies);
        session.hsb.edit([on](HsbMapping& h) { h.on = on; });
    };
    m_opening.editInJob(on ? tr("Colours from variables") : tr("Colours of the transfer function"), change);
    m_on->setChecked(m_services.store().session().hsb->on); // until it has been done
}

bool ChannelsBox::isFast() const {
    const Scene& scene = m_services.scene();
    return !scene.session.hsb->on || (scene.volume && scene.volume->size() <= kFastVoxels);
}

void ChannelsBox::edit(const QString& text, const QString& mergeKey, const SessionStore::Change& change) {
    if (!isFast()) return m_opening.editInJob(text, change);
    try {
        m_services.store().edit(text, mergeKey, change);
    } catch (const Error& error) { // a frame that has gone since
        m_services.showError(tr("Cannot make the colours"), error);
    }
}

void ChannelsBox::preview(const QString& text, const SessionStore::Change& change) {
    try {
        m_services.store().preview(text, change);
    } catch (const Error& error) {
        m_services.store().cancel();
        m_services.showError(tr("Cannot make the colours"), error);
    }
}

void ChannelsBox::followChannel(Channel channel) {
    const Scene& scene = m_services.scene();
    const Session& session = scene.session;
    QComboBox& combo = *m_channels[indexOf(channel)];
    combo.clear();
    const auto add = [&](const std::string& name) {
        if (const QString key = QString::fromStdString(name); combo.findData(key) < 0)
            combo.addItem(channel == Channel::Opacity ? featuresText(session, name) : driverText(session, name), key);
    };
    if (channel != Channel::Opacity)
        combo.addItem(channel == Channel::Hue ? tr("the same everywhere") : tr("full everywhere"), QString());
    for (const Variable& v : *session.variables) add(v.name);
    combo.insertSeparator(combo.count());
    for (const Variable& v : *session.variables) {
        if (v.derivation) continue;
        Derivation derivation;
        derivation.of = v.name;
        const auto isThere = [&] { // as a variable: it is in the list already
            return channel == Channel::Opacity &&
                   std::any_of(session.variables->begin(), session.variables->end(), [&](const Variable& w) {
                       return w.derivation && w.derivation->kind == derivation.kind && w.derivation->of == v.name;
                   });
        };
        if (scene.series && scene.series->varies()) {
            derivation.kind = Derivation::Kind::Volatility;
            derivation.frames = volatilityFrames(session).value_or(derivation.frames);
            if (!isThere()) add(derivation.text());
        }
        derivation.kind = Derivation::Kind::Gradient;
        if (!isThere()) add(derivation.text());
    }
    const std::string present = channelOf(session, channel);
    if (!present.empty()) add(present);
    combo.setCurrentIndex(combo.findData(QString::fromStdString(present)));
}

void ChannelsBox::follow() {
    const Scene& scene = m_services.scene();
    setEnabled(m_services.isEditable());
    if (!m_services.store().hasVolume()) return;
    const HsbMapping& hsb = *scene.session.hsb;
    m_on->setChecked(hsb.on);
    for (const Channel channel : kChannels) followChannel(channel);
    const auto frames = volatilityFrames(scene.session);
    m_frames->setEnabled(hsb.on && frames.has_value());
    const auto featuresOver = featureFrames(scene.session);
    m_featureFrames->setVisible(featuresOver.has_value());
    const QSignalBlocker still(m_frames), quiet(m_hueSlider), calm(m_featureFrames);
    if (frames) m_frames->setValue(*frames);
    if (featuresOver) m_featureFrames->setValue(*featuresOver);
    const bool constant = hsb.hue.empty();
    const double turned = hsb.hueFrom - 360 * std::floor(hsb.hueFrom / 360);
    if (!m_hueSlider->isSliderDown()) m_hueSlider->setValue(static_cast<int>(std::lround(turned)) % 360);
    showNumber(*m_hueFrom, hsb.hueFrom);
    showNumber(*m_hueTo, hsb.hueTo);
    m_hueSwatch->setPixmap(swatchOf(QColor::fromHsvF(static_cast<float>(turned / 360), 1, 1), 16, 16));
    m_hueSlider->setVisible(constant);
    m_hueSwatch->setVisible(constant);
    m_hueFrom->setPrefix(constant ? QString() : tr("from "));
    m_hueTo->setVisible(!constant);
    for (const Channel channel : {Channel::Saturation, Channel::Brightness, Channel::Hue})
        m_channels[indexOf(channel)]->setEnabled(hsb.on);
    for (QWidget* widget : std::initializer_list<QWidget*>{m_hueSlider, m_hueFrom, m_hueTo}) widget->setEnabled(hsb.on);
    m_swap->setEnabled(!hsb.brightness.empty() && hsb.brightness != scene.session.variable().name);
    const bool oneFrame = scene.series && !scene.series->varies();
    m_note->setText(featuresOver && oneFrame ? tr("There is one frame: its volatility is 0, and there are no features.")
                    : frames && oneFrame     ? tr("There is one frame: its volatility is 0, and all is grey.")
                                             : QString());
    m_note->setVisible(!m_note->text().isEmpty());
}

} // namespace pellucid::gui
