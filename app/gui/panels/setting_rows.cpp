#include "panels/setting_rows.h"

#include <cmath>

#include <QCheckBox>
#include <QColorDialog>
#include <QComboBox>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QSignalBlocker>
#include <QSlider>
#include <QSpinBox>
#include <QToolButton>

#include "services/services.h"
#include "widgets/number_box.h"
#include "widgets/theme.h"

namespace pellucid::gui {

namespace {

constexpr int kSliderSteps = 200;
constexpr int kTipWidth = 90; ///< letters

/// Between what is shown and the places of a slider.
struct Scale {
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

/// A number, whether it is optional or not; empty: none.
std::optional<double> numberIn(const Setting& setting, const void* settings) {
    const SettingValue value = setting.at(const_cast<void*>(settings));
    if (const auto* plain = std::get_if<double*>(&value)) return **plain;
    return *std::get<std::optional<double>*>(value);
}
void setNumber(const Setting& setting, void* settings, std::optional<double> number) {
    const SettingValue value = setting.at(settings);
    if (const auto* plain = std::get_if<double*>(&value))
        **plain = *number;
    else
        *std::get<std::optional<double>*>(value) = number;
}

template <class T>
T& valueIn(const Setting& setting, const void* settings) {
    return *std::get<T*>(setting.at(const_cast<void*>(settings)));
}

/// What a setting does, with its range and unit, in lines of a tool tip.
QString tipOf(const Setting& setting) {
    QString text = QString::fromUtf8(setting.help);
    const NumberRange usual; // of what is no number, too
    if (*setting.unit != '\0' || setting.range.lo != usual.lo || setting.range.hi != usual.hi ||
        setting.range.open != usual.open)
        text += QStringLiteral(" (%1%2)").arg(
            QString::fromStdString(setting.range.text()),
            *setting.unit == '\0' ? QString() : QStringLiteral(" ") + QString::fromUtf8(setting.unit));
    QString lines;
    int length = 0;
    for (const QString& word : text.split(' ')) {
        const bool breaks = length > 0 && length + word.size() > kTipWidth;
        lines += (lines.isEmpty() ? "" : breaks ? "\n" : " ") + word;
        length = (breaks ? 0 : length + 1) + static_cast<int>(word.size());
    }
    return lines;
}

} // namespace

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
        addCheck(setting, controls);
    else if (std::holds_alternative<int*>(kind))
        addWhole(setting, look, controls);
    else if (std::holds_alternative<Choice>(kind))
        addChoice(setting, controls);
    else if (std::holds_alternative<Rgb*>(kind))
        addColor(setting, controls);
    else
        addNumber(setting, look, controls);
    controls.front()->setObjectName(look.id);
    m_rows.push_back({&setting, controls.front()});
    for (QWidget* control : controls) control->setToolTip(tipOf(setting));
    m_show.push_back([this, &setting, controls] {
        for (QWidget* control : controls) control->setEnabled(m_services.isEditable() && setting.isUsed(present()));
    });
    return controls.front();
}

void SettingRows::addNumber(const Setting& setting, const RowLook& look, std::vector<QWidget*>& controls) {
    auto* box = new NumberBox;
    const double smallest = std::pow(10.0, -look.decimals);
    using Open = NumberRange::Open;
    const double lowest = setting.range.lo * look.factor + (setting.range.open == Open::Low ? smallest : 0);
    const double highest =
        std::min(setting.range.hi * look.factor, 1e9) - (setting.range.open == Open::High ? smallest : 0);
    box->setDecimals(look.decimals);
    box->setRange(lowest, highest);
    box->setSingleStep(look.step);
    box->setKeyboardTracking(false);
    box->setSuffix(!look.suffix.isEmpty()  ? look.suffix
                   : *setting.unit == '\0' ? QString()
                                           : QStringLiteral(" ") + QString::fromUtf8(setting.unit));
    const double factor = look.factor;
    const auto writeOf = [&setting, factor](double shown) {
        return [&setting, number = shown / factor](void* settings) { setNumber(setting, settings, number); };
    };
    connect(box, &QDoubleSpinBox::valueChanged, this,
            [this, &setting, writeOf, id = look.id](double shown) { edit(setting, id, writeOf(shown)); });
    controls.push_back(box);
    auto* row = new QHBoxLayout;
    QSlider* slider = nullptr;
    const Scale scale{look.least.value_or(lowest), look.most.value_or(highest), look.logarithmic};
    if (look.slider) {
        slider = new QSlider(Qt::Horizontal);
        slider->setObjectName(look.id + "Slider");
        slider->setRange(0, kSliderSteps);
        slider->setPageStep(kSliderSteps / 10);
        slider->setMinimumWidth(60);
        row->addWidget(slider, 1);
        controls.push_back(slider);
        const auto writeAt = [writeOf, scale, isWhole = look.decimals == 0](int place) {
            const double number = scale.numberAt(place);
            return writeOf(isWhole ? std::round(number) : number);
        };
        connect(slider, &QSlider::valueChanged, this, [=, this, &setting, id = look.id](int place) {
            if (!slider->isSliderDown()) return edit(setting, id, writeAt(place));
            if (m_isFast()) preview(setting, writeAt(place));
        });
        connect(slider, &QSlider::sliderReleased, this, [=, this, &setting] {
            m_isFast() ? m_services.store().commit() : edit(setting, {}, writeAt(slider->value()));
        });
    }
    row->addWidget(box, look.slider ? 0 : 1);
    QToolButton* automatic = nullptr;
    if (std::holds_alternative<std::optional<double>*>(setting.at(const_cast<void*>(present())))) {
        automatic = new QToolButton;
        automatic->setObjectName(look.id + "Automatic");
        automatic->setText(tr("auto"));
        automatic->setCheckable(true);
        row->addWidget(automatic);
        controls.push_back(automatic);
        connect(automatic, &QToolButton::clicked, this, [=, this, &setting, none = look.automatic](bool on) {
            std::optional<double> number; // what stood for none stays, with all its digits
            if (!on) number = none ? none() : box->value() / factor;
            edit(setting, {}, [&setting, number](void* settings) { setNumber(setting, settings, number); });
        });
    }
    m_form.addRow(QString::fromUtf8(setting.words), row);
    if (auto* label = qobject_cast<QLabel*>(m_form.labelForField(row))) label->setBuddy(box);
    m_show.push_back([=, this, &setting, none = look.automatic] {
        std::optional<double> number = numberIn(setting, present());
        if (automatic != nullptr) automatic->setChecked(!number);
        if (!number && none) number = none();
        if (!number) return;
        const QSignalBlocker quiet(box);
        showNumber(*box, *number * factor);
        if (slider == nullptr || slider->isSliderDown()) return;
        const QSignalBlocker still(slider);
        slider->setValue(scale.placeOf(*number * factor));
    });
}

void SettingRows::addWhole(const Setting& setting, const RowLook& look, std::vector<QWidget*>& controls) {
    auto* box = new QSpinBox;
    box->setRange(static_cast<int>(setting.range.lo), static_cast<int>(setting.range.hi));
    box->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
    box->setGroupSeparatorShown(true);
    box->setKeyboardTracking(false);
    if (*setting.unit != '\0') box->setSuffix(QStringLiteral(" ") + QString::fromUtf8(setting.unit));
    m_form.addRow(QString::fromUtf8(setting.words), box);
    connect(box, &QSpinBox::valueChanged, this, [this, &setting, id = look.id](int number) {
        edit(setting, id, [&setting, number](void* settings) { valueIn<int>(setting, settings) = number; });
    });
    controls.push_back(box);
    m_show.push_back([this, &setting, box] {
        const QSignalBlocker quiet(box);
        if (const int number = valueIn<int>(setting, present()); box->value() != number) box->setValue(number);
    });
}

void SettingRows::addCheck(const Setting& setting, std::vector<QWidget*>& controls) {
    auto* box = new QCheckBox(QString::fromUtf8(setting.words));
    m_form.addRow(QString(), box);
    connect(box, &QCheckBox::clicked, this, [this, &setting](bool on) {
        edit(setting, {}, [&setting, on](void* settings) { valueIn<bool>(setting, settings) = on; });
    });
    controls.push_back(box);
    m_show.push_back([this, &setting, box] { box->setChecked(valueIn<bool>(setting, present())); });
}

void SettingRows::addChoice(const Setting& setting, std::vector<QWidget*>& controls) {
    auto* box = new QComboBox;
    const Choice choice = std::get<Choice>(setting.at(const_cast<void*>(present())));
    for (const char* name : setting.choices.empty() ? choice.names : setting.choices)
        box->addItem(QString::fromUtf8(name), box->count());
    m_form.addRow(QString::fromUtf8(setting.words), box);
    connect(box, &QComboBox::activated, this, [this, &setting, box] {
        edit(setting, {}, [&setting, index = box->currentData().toInt()](void* settings) {
            const Choice chosen = std::get<Choice>(setting.at(settings));
            chosen.set(chosen.value, index);
        });
    });
    controls.push_back(box);
    m_show.push_back([this, &setting, box] {
        box->setCurrentIndex(box->findData(std::get<Choice>(setting.at(const_cast<void*>(present()))).index()));
    });
}

void SettingRows::addColor(const Setting& setting, std::vector<QWidget*>& controls) {
    auto* button = new QPushButton;
    m_form.addRow(QString::fromUtf8(setting.words), button);
    connect(button, &QPushButton::clicked, this, [this, &setting, button] {
        const QColor color =
            QColorDialog::getColor(colorFromRgb(valueIn<Rgb>(setting, present())), button, textOf(setting));
        if (color.isValid())
            edit(setting, {}, [&setting, color](void* s) { valueIn<Rgb>(setting, s) = rgbFromColor(color); });
    });
    controls.push_back(button);
    m_show.push_back([this, &setting, button] {
        const QColor color = colorFromRgb(valueIn<Rgb>(setting, present()));
        QPixmap swatch(28, 12);
        swatch.fill(color);
        button->setIcon(QIcon(swatch));
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

void SettingRows::preview(const Setting& setting, const Write& write) {
    m_preview(textOf(setting), changeOf(setting, write));
}

void SettingRows::follow() {
    for (const auto& show : m_show) show();
}

} // namespace pellucid::gui
