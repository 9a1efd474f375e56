#include "panels/setting_rows.h"

#include <cmath>

#include <QCheckBox>
#include <QColorDialog>
#include <QComboBox>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QPushButton>
#include <QSignalBlocker>
#include <QSlider>
#include <QSpinBox>

#include "base/check.h"
#include "services/services.h"
#include "widgets/controls.h"
#include "widgets/number_box.h"
#include "widgets/setting_tip.h"
#include "widgets/theme.h"

namespace pellucid::gui {

namespace {

constexpr int kSliderSteps = 200;
constexpr const char* kPressedAt = "pressedAt"; ///< the place of a slider when the hand took it

/// A value that may be optional or not; empty: none.
template <class T>
std::optional<T> maybeIn(const Setting& setting, const void* settings) {
    const SettingValue value = setting.at(const_cast<void*>(settings));
    if (const auto* plain = std::get_if<T*>(&value)) return **plain;
    return *std::get<std::optional<T>*>(value);
}
template <class T>
void setMaybe(const Setting& setting, void* settings, const std::optional<T>& wanted) {
    const SettingValue value = setting.at(settings);
    if (const auto* plain = std::get_if<T*>(&value))
        **plain = *wanted;
    else
        *std::get<std::optional<T>*>(value) = wanted;
}

/// The least and the largest number that a row shows.
std::pair<double, double> shownEnds(const Setting& setting, const RowLook& look) {
    using Open = NumberRange::Open;
    const double smallest = std::pow(10.0, -look.decimals);
    return {std::max(setting.range.lo * look.factor, -1e9) + (setting.range.open == Open::Low ? smallest : 0),
            std::min(setting.range.hi * look.factor, 1e9) - (setting.range.open == Open::High ? smallest : 0)};
}

/// What stands behind a number.
QString suffixOf(const Setting& setting, const RowLook& look) {
    return look.suffix.isEmpty() ? QString::fromStdString(setting.unitText()) : look.suffix;
}

/// Sets a number that is given as it is shown.
std::function<void(void*)> writeOf(const Setting& setting, const RowLook& look, double shown) {
    return [&setting, number = shown / look.factor](void* settings) { setMaybe<double>(setting, settings, number); };
}

template <class T>
T& valueIn(const Setting& setting, const void* settings) {
    return *std::get<T*>(setting.at(const_cast<void*>(settings)));
}

} // namespace

/// Between what is shown and the places of a slider.
struct SettingRows::Scale {
    double lo, hi;
    bool logarithmic;
    int placeOf(double number) const {
        const double part =
            logarithmic ? std::log(std::max(number, lo) / lo) / std::log(hi / lo) : (number - lo) / (hi - lo);
        return static_cast<int>(std::lround(part * kSliderSteps));
    }
    double numberAt(int place) const {
        const double part = static_cast<double>(place) / kSliderSteps;
        return logarithmic ? lo * std::pow(hi / lo, part) : lo + part * (hi - lo);
    }
};

SettingRows::SettingRows(Services& services, QFormLayout& form, SettingPart part, RowStep step)
    : QObject(form.parentWidget()), m_services(services), m_form(form), m_part(std::move(part)),
      m_step(std::move(step)) {
    m_commit = [this](const QString& text, const QString& mergeKey, const SessionStore::Change& change) {
        m_services.store().edit(text, mergeKey, change);
    };
    m_preview = [this](const QString& text, const SessionStore::Change& change) {
        m_services.store().preview(text, change);
    };
    m_isFast = [] { return true; };
    connect(&services.store(), &SessionStore::changed, this, [this](const Scene& before, const Scene& after) {
        if (before.volume != after.volume || !m_part.isSame(before.session, after.session)) follow();
    });
    connect(&services, &Services::readOnlyChanged, this, &SettingRows::follow);
}

QWidget* SettingRows::add(const char* key, const RowLook& look) {
    const Setting& setting = settingOf(m_part.settings, key);
    const SettingValue kind = setting.at(const_cast<void*>(present()));
    m_looks[&setting] = look;
    std::vector<QWidget*> controls; // the one that has the name first
    if (std::holds_alternative<bool*>(kind))
        controls.push_back(makeCheck(setting));
    else if (std::holds_alternative<int*>(kind))
        controls.push_back(makeWhole(setting, look));
    else if (std::holds_alternative<Choice>(kind))
        controls.push_back(makeChoice(setting));
    else if (std::holds_alternative<Rgb*>(kind) || std::holds_alternative<std::optional<Rgb>*>(kind))
        addColor(setting, look, controls);
    else {
        PELLUCID_CHECK(isNumber(kind));
        addNumber(setting, look, controls);
    }
    controls.front()->setObjectName(look.id);
    m_rows.push_back({&setting, controls.front()});
    const QString tip = settingTip(setting, isNumber(kind), suffixOf(setting, look), look.factor);
    for (QWidget* control : controls) control->setToolTip(tip);
    m_show.push_back([this, &setting, controls] {
        for (QWidget* control : controls) control->setEnabled(m_services.isEditable() && setting.isUsed(present()));
    });
    return controls.front();
}

void SettingRows::addNumber(const Setting& setting, const RowLook& look, std::vector<QWidget*>& controls) {
    const auto [lowest, highest] = shownEnds(setting, look);
    auto* box = new NumberBox;
    withLook(box, {lowest, highest, look.decimals, look.step});
    box->setSuffix(suffixOf(setting, look));
    connect(box, &QDoubleSpinBox::valueChanged, this,
            [this, &setting, look](double shown) { edit(setting, look.id, writeOf(setting, look, shown)); });
    controls.push_back(box);
    const Scale scale{look.least.value_or(lowest), look.most.value_or(highest), look.logarithmic};
    QSlider* const slider = look.slider ? makeSlider(setting, look, scale) : nullptr;
    const bool optional = std::holds_alternative<std::optional<double>*>(setting.at(const_cast<void*>(present())));
    QToolButton* const automatic = optional ? makeAutomatic(setting, look, *box) : nullptr;
    auto* row = new QHBoxLayout;
    if (slider != nullptr) {
        row->addWidget(slider, 1);
        controls.push_back(slider);
    }
    row->addWidget(box, look.slider ? 0 : 1);
    if (automatic != nullptr) {
        row->addWidget(automatic);
        controls.push_back(automatic);
    }
    m_form.addRow(QString::fromUtf8(setting.words), row);
    if (auto* label = qobject_cast<QLabel*>(m_form.labelForField(row))) label->setBuddy(box);
    m_show.push_back([=, this, &setting] {
        std::optional<double> number = maybeIn<double>(setting, present());
        if (automatic != nullptr) automatic->setChecked(!number);
        if (!number && look.automatic) number = look.automatic();
        if (!number) return;
        const QSignalBlocker quiet(box);
        showNumber(*box, *number * look.factor);
        if (slider == nullptr || slider->isSliderDown()) return;
        const QSignalBlocker still(slider);
        slider->setValue(scale.placeOf(*number * look.factor));
    });
}

QSlider* SettingRows::makeSlider(const Setting& setting, const RowLook& look, const Scale& scale) {
    auto* slider = named(new QSlider(Qt::Horizontal), look.id + "Slider");
    slider->setRange(0, kSliderSteps);
    slider->setPageStep(kSliderSteps / 10);
    slider->setMinimumWidth(60);
    const auto writeAt = [&setting, look, scale](int place) {
        const double number = scale.numberAt(place);
        return writeOf(setting, look, look.decimals == 0 ? std::round(number) : number);
    };
    connect(slider, &QSlider::valueChanged, this, [=, this, &setting](int place) {
        if (!slider->isSliderDown()) return edit(setting, look.id, writeAt(place));
        if (m_isFast()) m_preview(textOf(setting), changeOf(setting, writeAt(place)));
    });
    connect(slider, &QSlider::sliderPressed, slider, [slider] { slider->setProperty(kPressedAt, slider->value()); });
    connect(slider, &QSlider::sliderReleased, this, [=, this, &setting] {
        m_services.store().commit(); // what was previewed
        // A click without a move keeps a number that lies between two places.
        if (slider->property(kPressedAt) != slider->value()) edit(setting, {}, writeAt(slider->value()));
    });
    return slider;
}

QToolButton* SettingRows::makeAutomatic(const Setting& setting, const RowLook& look, const QDoubleSpinBox& box) {
    auto* automatic = named(toolButton(tr("auto"), nullptr), look.id + "Automatic");
    automatic->setCheckable(true);
    connect(automatic, &QToolButton::clicked, this, [this, &setting, look, &box](bool on) {
        std::optional<double> number; // what stood for none stays, with all its digits
        if (!on && look.automatic)    // of a black picture there may be none that is allowed
            number = std::clamp(look.automatic(), box.minimum() / look.factor, box.maximum() / look.factor);
        else if (!on)
            number = box.value() / look.factor;
        edit(setting, {}, [&setting, number](void* settings) { setMaybe<double>(setting, settings, number); });
    });
    return automatic;
}

QWidget* SettingRows::makeWhole(const Setting& setting, const RowLook& look) {
    auto* box = new QSpinBox;
    box->setRange(static_cast<int>(setting.range.lo), static_cast<int>(setting.range.hi));
    box->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
    box->setGroupSeparatorShown(true);
    box->setKeyboardTracking(false);
    box->setSuffix(QString::fromStdString(setting.unitText()));
    m_form.addRow(QString::fromUtf8(setting.words), box);
    connect(box, &QSpinBox::valueChanged, this, [this, &setting, id = look.id](int number) {
        edit(setting, id, [&setting, number](void* settings) { valueIn<int>(setting, settings) = number; });
    });
    m_show.push_back([this, &setting, box] {
        const QSignalBlocker quiet(box);
        if (const int number = valueIn<int>(setting, present()); box->value() != number) box->setValue(number);
    });
    return box;
}

QWidget* SettingRows::makeCheck(const Setting& setting) {
    auto* box = new QCheckBox(QString::fromUtf8(setting.words));
    m_form.addRow(QString(), box);
    connect(box, &QCheckBox::clicked, this, [this, &setting](bool on) {
        edit(setting, {}, [&setting, on](void* settings) { valueIn<bool>(setting, settings) = on; });
    });
    m_show.push_back([this, &setting, box] { box->setChecked(valueIn<bool>(setting, present())); });
    return box;
}

QWidget* SettingRows::makeChoice(const Setting& setting) {
    auto* box = new QComboBox;
    const Choice choice = std::get<Choice>(setting.at(const_cast<void*>(present())));
    for (const char* name : setting.choices.empty() ? choice.names : setting.choices)
        box->addItem(QString::fromUtf8(name), box->count());
    m_form.addRow(QString::fromUtf8(setting.words), box);
    connect(box, &QComboBox::activated, this, [this, &setting](int index) {
        edit(setting, {}, [&setting, index](void* settings) {
            const Choice chosen = std::get<Choice>(setting.at(settings));
            chosen.set(chosen.value, index);
        });
    });
    m_show.push_back([this, &setting, box] {
        box->setCurrentIndex(box->findData(std::get<Choice>(setting.at(const_cast<void*>(present()))).index()));
    });
    return box;
}

void SettingRows::addColor(const Setting& setting, const RowLook& look, std::vector<QWidget*>& controls) {
    auto* button = named(new QPushButton, look.colorId);
    QCheckBox* check = nullptr;
    if (std::holds_alternative<std::optional<Rgb>*>(setting.at(const_cast<void*>(present())))) {
        check = new QCheckBox;
        controls.push_back(check);
        connect(check, &QCheckBox::clicked, this, [this, &setting, first = look.firstColor](bool on) {
            const auto color = on ? std::optional(first) : std::nullopt;
            edit(setting, {}, [&setting, color](void* settings) { setMaybe<Rgb>(setting, settings, color); });
        });
    }
    controls.push_back(button);
    connect(button, &QPushButton::clicked, this, [this, &setting, button] {
        const Rgb now = maybeIn<Rgb>(setting, present()).value_or(Rgb{});
        const QColor color = QColorDialog::getColor(colorFromRgb(now), button, textOf(setting));
        if (color.isValid())
            edit(setting, {}, [&setting, color](void* s) { setMaybe<Rgb>(setting, s, rgbFromColor(color)); });
    });
    auto* row = new QHBoxLayout;
    if (check != nullptr) row->addWidget(check);
    row->addWidget(button, 1);
    m_form.addRow(QString::fromUtf8(setting.words), row);
    m_show.push_back([=, this, &setting] {
        const std::optional<Rgb> now = maybeIn<Rgb>(setting, present());
        if (check != nullptr) check->setChecked(now.has_value());
        button->setVisible(now.has_value());
        if (!now) return;
        const QColor color = colorFromRgb(*now);
        button->setIcon(swatchOf(color, 28, 12));
        button->setText(color.name());
    });
}

const void* SettingRows::present() const { return m_part.read(m_services.store().session()); }

QString SettingRows::textOf(const Setting& setting) const {
    if (!m_step.text.isEmpty()) return m_step.text;
    const QString& own = m_looks.at(&setting).stepText;
    return own.isEmpty() ? QString::fromStdString(setting.name()) : own;
}

SessionStore::Change SettingRows::changeOf(const Setting& setting, const Write& write) const {
    return [edit = m_part.edit, write, then = m_looks.at(&setting).then](Session& session) {
        edit(session, [&](void* settings) {
            write(settings);
            if (then) then(settings);
        });
    };
}

void SettingRows::edit(const Setting& setting, const QString& mergeKey, const Write& write) {
    m_commit(textOf(setting), m_step.mergeKey.isEmpty() ? mergeKey : m_step.mergeKey, changeOf(setting, write));
    follow(); // also where nothing has come of it
}

void SettingRows::follow() {
    for (const auto& show : m_show) show();
}

} // namespace pellucid::gui
