#include "dialogs/preferences_dialog.h"

#include <QApplication>
#include <QCheckBox>
#include <QComboBox>
#include <QFormLayout>
#include <QGroupBox>
#include <QHeaderView>
#include <QLabel>
#include <QPushButton>
#include <QSignalBlocker>
#include <QSpinBox>
#include <QTreeWidget>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/text.h"
#include "dialogs/closing_buttons.h"
#include "widgets/controls.h"
#include "widgets/layouts.h"
#include "widgets/number_box.h"
#include "widgets/setting_tip.h"

namespace pellucid::gui {
namespace {

constexpr int kWidth = 520;       // logical pixels
constexpr double kMemoryStep = 1; // GiB

QString idOf(const Setting& setting) {
    QString key = setting.key;
    key[0] = key[0].toUpper();
    return "preferences" + key;
}

template <class T>
T& valueIn(const Setting& setting, Preferences& preferences) {
    return *std::get<T*>(setting.at(&preferences));
}

QGroupBox* groupOf(const QString& title, QLayout* content) {
    auto* group = new QGroupBox(title);
    group->setLayout(content);
    return group;
}

} // namespace

PreferencesDialog::PreferencesDialog(Hooks hooks, QWidget* parent)
    : QDialog(parent), m_hooks(std::move(hooks)), m_now(keptPreferences()), m_mouse(new QTreeWidget(this)),
      m_memoryNow(wrappedLabel("preferencesMemoryNow", this)) {
    setObjectName("preferencesDialog");
    setWindowTitle(tr("Preferences"));
    auto *look = new QFormLayout, *mouse = new QFormLayout, *work = new QFormLayout, *files = new QFormLayout;
    addRow(*look, "theme");
    addRow(*mouse, "mouse");
    mouse->addRow(mouseTable());
    addRow(*work, "memoryGiB");
    addRow(*work, "threads");
    makeFaint(*m_memoryNow);
    work->addRow(m_memoryNow);
    addRow(*files, "recentCount");
    addRow(*files, "recentPictures");
    addRow(*files, "recentAtStart");
    auto* clear = named(new QPushButton(tr("&Clear the list")), "preferencesClearRecent",
                        tr("Forgets the recent files, and removes their pictures"));
    m_clear = clear;
    files->addRow(rowOf({clear, Cell::rest()}));
    auto* buttons = closingButtons(*this, QDialogButtonBox::RestoreDefaults | QDialogButtonBox::Close);
    QPushButton* defaults = buttons->button(QDialogButtonBox::RestoreDefaults);
    named(defaults, "preferencesDefaults", tr("All of this as the program came"));
    QPushButton* close = buttons->button(QDialogButtonBox::Close);
    close->setToolTip(tr("What you have changed holds already"));
    for (QPushButton* button : {clear, defaults, close}) button->setAutoDefault(false); // Return ends a number
    setLayout(columnOf({groupOf(tr("Appearance"), look), groupOf(tr("Mouse over the volume"), mouse),
                        groupOf(tr("Memory and threads"), work), groupOf(tr("Recent files"), files), buttons}));
    resize(kWidth, sizeHint().height());

    connect(clear, &QPushButton::clicked, this, [this] {
        m_hooks.clearRecent();
        follow();
    });
    connect(defaults, &QPushButton::clicked, this, &PreferencesDialog::restoreDefaults);
    follow();
}

QWidget* PreferencesDialog::addRow(QFormLayout& form, const char* key) {
    const Setting& setting = settingOf(settingsOf<Preferences>(), key);
    QWidget* control = controlOf(setting);
    named(control, idOf(setting),
          settingTip(setting, isNumber(setting.at(&m_now)), QString::fromStdString(setting.unitText())));
    if (qobject_cast<QCheckBox*>(control) != nullptr)
        form.addRow(control);
    else
        form.addRow(QString::fromUtf8(setting.words), control);
    return control;
}

QWidget* PreferencesDialog::controlOf(const Setting& setting) {
    const SettingValue kind = setting.at(&m_now);
    if (std::holds_alternative<Choice>(kind)) return choiceOf(setting);
    if (std::holds_alternative<bool*>(kind)) return flagOf(setting);
    return std::holds_alternative<int*>(kind) ? wholeOf(setting) : numberOf(setting);
}

QWidget* PreferencesDialog::numberOf(const Setting& setting) {
    auto* box = new NumberBox;
    withLook(box, {0, setting.range.hi, 1, kMemoryStep, QString::fromStdString(setting.unitText())});
    box->setSpecialValueText(tr("what is free"));
    connect(box, &QDoubleSpinBox::valueChanged, this, [this, &setting](double number) {
        edit([&] {
            valueIn<std::optional<double>>(setting, m_now) = number > 0 ? std::optional(number) : std::nullopt;
        });
    });
    m_show.push_back([this, &setting, box] {
        const QSignalBlocker quiet(box);
        box->setValue(valueIn<std::optional<double>>(setting, m_now).value_or(0));
    });
    return box;
}

QWidget* PreferencesDialog::wholeOf(const Setting& setting) {
    auto* box = new QSpinBox;
    box->setRange(static_cast<int>(setting.range.lo), static_cast<int>(setting.range.hi));
    box->setKeyboardTracking(false);
    if (std::string_view(setting.key) == "threads") box->setSpecialValueText(tr("all cores"));
    connect(box, &QSpinBox::valueChanged, this,
            [this, &setting](int number) { edit([&] { valueIn<int>(setting, m_now) = number; }); });
    m_show.push_back([this, &setting, box] {
        const QSignalBlocker quiet(box);
        box->setValue(valueIn<int>(setting, m_now));
    });
    return box;
}

QWidget* PreferencesDialog::choiceOf(const Setting& setting) {
    auto* box = new QComboBox;
    for (const char* name : setting.choices) box->addItem(QString::fromUtf8(name));
    connect(box, &QComboBox::activated, this, [this, &setting](int index) {
        edit([&] {
            const Choice choice = std::get<Choice>(setting.at(&m_now));
            choice.set(choice.value, index);
        });
    });
    m_show.push_back([this, &setting, box] { box->setCurrentIndex(std::get<Choice>(setting.at(&m_now)).index()); });
    return box;
}

QWidget* PreferencesDialog::flagOf(const Setting& setting) {
    auto* box = new QCheckBox(QString::fromUtf8(setting.words));
    connect(box, &QCheckBox::clicked, this,
            [this, &setting](bool on) { edit([&] { valueIn<bool>(setting, m_now) = on; }); });
    m_show.push_back([this, &setting, box] { box->setChecked(valueIn<bool>(setting, m_now)); });
    return box;
}

QWidget* PreferencesDialog::mouseTable() {
    named(m_mouse, "preferencesMouseTable", tr("What the mouse and the keys do over the volume"));
    m_mouse->setAccessibleName(tr("Mouse over the volume"));
    m_mouse->setHeaderLabels({tr("Mouse and keys"), tr("What it does")});
    m_mouse->setRootIsDecorated(false);
    m_mouse->setTabKeyNavigation(false);
    m_mouse->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
    m_mouse->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    m_mouse->header()->setStretchLastSection(true);
    m_mouse->header()->setSectionResizeMode(0, QHeaderView::ResizeToContents);
    m_show.push_back([this] {
        m_mouse->clear();
        for (const MotionText& text : motionTexts(m_now.mouse)) new QTreeWidgetItem(m_mouse, {text.how, text.what});
        m_mouse->setCurrentItem(m_mouse->topLevelItem(0));
    });
    // As high as the longest of the tables, so that the dialog keeps its size.
    std::size_t most = 0;
    for (const MouseScheme scheme : allOf<MouseScheme>()) most = std::max(most, motionTexts(scheme).size());
    new QTreeWidgetItem(m_mouse, {"x", "x"});
    m_mouse->setFixedHeight(m_mouse->header()->sizeHint().height() + 2 * m_mouse->frameWidth() +
                            static_cast<int>(most) * std::max(m_mouse->sizeHintForRow(0), 1));
    return m_mouse;
}

void PreferencesDialog::edit(const std::function<void()>& change) {
    const Theme before = m_now.theme;
    change();
    keepPreferences(m_now);
    applyPreferences(m_now);
    if (m_now.theme != before) applyTheme(*qApp, m_now.theme);
    m_hooks.changed();
    follow();
}

void PreferencesDialog::restoreDefaults() {
    edit([this] { m_now = Preferences{}; });
}

void PreferencesDialog::follow() {
    for (const auto& show : m_show) show();
    const std::uint64_t used = usedMemoryBytes(), free = availableMemoryBytes();
    m_memoryNow->setText(tr("The program takes %1 now and may take %2 more. Threads in use: %3.")
                             .arg(QString::fromStdString(describeBytes(used)),
                                  QString::fromStdString(describeBytes(free)), QString::number(threadCount())));
    m_clear->setEnabled(m_hooks.hasRecent());
}

} // namespace pellucid::gui
