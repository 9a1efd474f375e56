#include "dialogs/film_dialog.h"

#include <algorithm>
#include <cmath>

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFileDialog>
#include <QFormLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QSpinBox>
#include <QStandardItemModel>

#include "dialogs/closing_buttons.h"
#include "render/render_settings.h"
#include "widgets/controls.h"
#include "widgets/layouts.h"
#include "widgets/named.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

const Setting& filmSetting(const char* key) { return settingOf(settingsOf<FilmSettings>(), key); }

} // namespace

FilmDialog::FilmDialog(const FilmOptions& offered, const QSize& seen, int series, std::optional<double> keys,
                       bool annotated, QWidget* parent)
    : QDialog(parent), m_series(series), m_keys(keys), m_offered(offered.settings),
      m_kind(named(new QComboBox(this), "filmKind", QString::fromUtf8(filmSetting("kind").help))),
      m_preset(named(new QComboBox(this), "filmPreset", tr("Sizes that are often wanted"))),
      m_seconds(numberBox("seconds", &FilmSettings::seconds, "filmSeconds", 2)),
      m_degrees(numberBox("degrees", &FilmSettings::degrees, "filmDegrees", 0)),
      m_rate(numberBox("fps", &FilmSettings::framesPerSecond, "filmRate", 2)),
      m_views(named(new QLineEdit(offered.views, this), "filmViews",
                    tr("Views with semicolons between: sides such as anterior, left, top; azimuth, elevation and\n"
                       "magnification such as 30,20,1.5; or present for the view of the window"))),
      m_path(named(new QLineEdit(offered.path, this), "filmPath",
                   tr("A name that ends in .mp4, .webm or .gif makes a film, for which ffmpeg must be installed, one\n"
                      "in .apng an animated picture without loss; any other is a folder, which gets the pictures one\n"
                      "by one: picture_00000.png and so on"))),
      m_width(named(new QSpinBox(this), "filmWidth", tr("Width of the film, pixels"))),
      m_height(named(new QSpinBox(this), "filmHeight", tr("Height of the film, pixels"))),
      m_annotated(named(new QCheckBox(tr("With &annotations"), this), "filmAnnotated",
                        tr("What the window shows around the picture: View → Annotations"))),
      m_summary(named(new QLabel(this), "filmSummary")) {
    setObjectName("filmDialog");
    setWindowTitle(tr("Save film"));
    for (const char* kind : filmSetting("kind").choices) m_kind->addItem(tr(kind));
    const auto leaveOut = [this](FilmKind kind, const QString& why) {
        auto* const model = qobject_cast<QStandardItemModel*>(m_kind->model());
        QStandardItem* const item = model->item(static_cast<int>(kind));
        item->setEnabled(false);
        item->setToolTip(why);
    };
    if (series == 0) leaveOut(FilmKind::Series, tr("The data have one frame"));
    if (!keys)
        leaveOut(FilmKind::Keys, tr("There are no keyframes yet: the panel Keyframes keeps what is shown as a key"));
    m_kind->setCurrentIndex(static_cast<int>(offered.settings.kind));
    m_annotated->setEnabled(annotated);
    m_annotated->setChecked(annotated);
    m_path->setMinimumWidth(340);
    makeSizes(seen);
    auto* const addView =
        named(new QPushButton(tr("Add present view"), this), "filmAddView", tr("Append the view that the window has"));
    auto* const browse = browseButton(*this);
    addView->setAutoDefault(false);
    connect(addView, &QPushButton::clicked, this, &FilmDialog::addPresentView);
    connect(browse, &QPushButton::clicked, this, &FilmDialog::browse);

    auto* const note = wrappedLabel("filmFormats", this);
    note->setText(tr("Names that end in .mp4, .webm or .gif make a film, which needs ffmpeg; .apng needs none. Any "
                     "other name makes a folder of pictures."));
    makeFaint(*note);
    auto* const form = inset(new QFormLayout(this), {18, 16, 18, 12});
    form->setVerticalSpacing(9);
    form->addRow(tr("&Kind"), m_kind);
    form->addRow(tr("&Turn"), m_degrees);
    auto* const views = new QWidget(this);
    views->setLayout(inset(rowOf({{m_views, 1}, addView}), {}));
    form->addRow(tr("&Views"), views);
    m_views->setAccessibleName(tr("Views"));
    m_width->setAccessibleName(tr("Width"));
    m_height->setAccessibleName(tr("Height"));
    form->addRow(tr("&Length"), m_seconds);
    form->addRow(tr("&Frames per second"), m_rate);
    form->addRow(tr("Size"), m_preset);
    form->addRow(QString(), rowOf({m_width, new QLabel(QStringLiteral("×"), this), m_height, Cell::rest()}));
    form->addRow(QString(), m_annotated);
    addRow(*form, tr("&File or folder"), m_path, rowOf({{m_path, 1}, browse}));
    form->addRow(QString(), note);
    form->addRow(QString(), m_summary);
    form->addRow(closingButtons(*this, QDialogButtonBox::Save | QDialogButtonBox::Cancel));
    m_ofTurntable = {m_degrees, form->labelForField(m_degrees)};
    m_ofViews = {views, form->labelForField(views)};
    m_ofLength = {m_seconds, form->labelForField(m_seconds)};

    connect(m_kind, &QComboBox::currentIndexChanged, this, &FilmDialog::follow);
    for (QDoubleSpinBox* box : {m_seconds, m_rate})
        connect(box, &QDoubleSpinBox::valueChanged, this, &FilmDialog::follow);
    follow();
}

QDoubleSpinBox* FilmDialog::numberBox(const char* key, double FilmSettings::*member, const QString& id, int decimals) {
    const Setting& setting = filmSetting(key);
    auto* const box = named(new QDoubleSpinBox(this), id, QString::fromUtf8(setting.help));
    box->setDecimals(decimals);
    const double least = std::pow(10.0, -decimals); // where the end itself is not allowed
    box->setRange(setting.range.holds(setting.range.lo) ? setting.range.lo : least, setting.range.hi);
    box->setSuffix(QString::fromStdString(setting.unitText()));
    box->setValue(m_offered.*member);
    return box;
}

void FilmDialog::makeSizes(const QSize& seen) {
    for (QSpinBox* box : {m_width, m_height}) {
        box->setRange(1, kMostPixels);
        box->setSuffix(tr(" px"));
    }
    const std::pair<QString, QSize> presets[] = {
        {tr("HD"), {1280, 720}}, {tr("Full HD"), {1920, 1080}}, {tr("As seen"), seen}, {tr("Square"), {720, 720}}};
    for (const auto& [text, size] : presets)
        m_preset->addItem(QStringLiteral("%1 (%2 × %3)").arg(text).arg(size.width()).arg(size.height()), size);
    const int custom = m_preset->count();
    m_preset->addItem(tr("Custom"));
    const auto apply = [this] {
        const QSize size = m_preset->currentData().toSize();
        if (size.isEmpty()) return; // what is there may be changed
        const QSignalBlocker quiet[] = {QSignalBlocker(m_width), QSignalBlocker(m_height)};
        m_width->setValue(size.width());
        m_height->setValue(size.height());
    };
    connect(m_preset, &QComboBox::activated, this, apply);
    for (QSpinBox* box : {m_width, m_height})
        connect(box, &QSpinBox::valueChanged, this, [this, custom] {
            const int preset = m_preset->findData(QSize(m_width->value(), m_height->value()));
            m_preset->setCurrentIndex(preset < 0 ? custom : preset);
        });
    apply();
}

void FilmDialog::addPresentView() {
    const QString before = m_views->text().trimmed();
    m_views->setText(before.isEmpty() || before.endsWith(';') ? before + m_present
                                                              : QStringLiteral("%1; %2").arg(before, m_present));
}

void FilmDialog::browse() {
    const QString chosen = QFileDialog::getSaveFileName(this, tr("Save film"), m_path->text(),
                                                        tr("Films (*.mp4 *.webm *.gif *.apng);;Folder of pictures (*)"),
                                                        nullptr, QFileDialog::DontConfirmOverwrite);
    if (!chosen.isEmpty()) m_path->setText(chosen);
}

void FilmDialog::follow() {
    const FilmSettings now = options().settings;
    const auto show = [](const QList<QWidget*>& row, bool shown) {
        for (QWidget* widget : row) widget->setVisible(shown);
    };
    show(m_ofTurntable, now.kind == FilmKind::Turntable);
    show(m_ofViews, now.kind == FilmKind::Views);
    show(m_ofLength, now.kind == FilmKind::Turntable || now.kind == FilmKind::Views);
    const double count = pictures(now);
    m_summary->setText(
        tr("%L1 pictures, %L2 s").arg(static_cast<int>(count)).arg(count / now.framesPerSecond, 0, 'f', 1));
}

double FilmDialog::pictures(const FilmSettings& settings) const {
    if (settings.kind == FilmKind::Series) return m_series;
    if (settings.kind == FilmKind::Keys) return picturesOf(m_keys.value_or(0), settings.framesPerSecond);
    return std::max(1.0, std::round(settings.seconds * settings.framesPerSecond));
}

FilmOptions FilmDialog::options() const {
    FilmOptions options;
    options.settings = {static_cast<FilmKind>(m_kind->currentIndex()), m_seconds->value(), m_rate->value(),
                        m_degrees->value()};
    options.views = m_views->text();
    options.size = {m_width->value(), m_height->value()};
    options.annotated = m_annotated->isChecked();
    options.path = m_path->text().trimmed();
    return options;
}

} // namespace pellucid::gui
