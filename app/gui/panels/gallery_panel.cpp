#include "panels/gallery_panel.h"

#include <QDir>
#include <QInputDialog>
#include <QListWidget>
#include <QMenu>
#include <QMessageBox>
#include <QStandardPaths>

#include "panels/panel.h"
#include "services/services.h"
#include "store/edits.h"
#include "tf/shown_tf.h"
#include "tf/tf_range.h"
#include "widgets/controls.h"
#include "widgets/elided.h"
#include "widgets/image_convert.h"
#include "widgets/layouts.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr int kWidth = 112, kHeight = 84; ///< of a picture, logical pixels
constexpr int kWait = 350;                ///< milliseconds after the last change, so that a turning hand is not slowed
constexpr const char* kThesis[] = {"tents:2", "tents:3", "tents:4", "tents:6", "ramp:6", "ramp:12"};

std::vector<TfPreset> thesisPresets() {
    std::vector<TfPreset> all;
    for (const char* spec : kThesis) {
        const std::string text = spec, number = text.substr(text.find(':') + 1);
        const bool areTents = text.starts_with("tents");
        all.push_back(
            {text, areTents ? number + " tents" : "Ramp of " + number, "Even",
             areTents ? "Tents of equal width and height over all values" : "Points of equal opacity over all values",
             *tfFromSpec(text)});
    }
    return all;
}

/// As it stands in the window of a volume; a window without width takes it as it is.
TransferFunction placed(const TransferFunction& tf, const ValueRange& window) {
    return window.lo < window.hi ? inRange(tf, window) : tf;
}

QString fileNameOf(const QString& title) {
    QString name;
    for (const QChar c : title.toLower()) name += c.isLetterOrNumber() ? c : QChar('-');
    return name + ".tf.json";
}

} // namespace

PanelInfo galleryPanel() {
    return {
        .id = "gallery",
        .title = QObject::tr("Presets"),
        .tabOf = "features",
        .keys = QKeySequence("Ctrl+9"),
        .tip = QObject::tr("Transfer functions as small pictures of this volume"),
        .make = [](Services& services, Controllers&, QWidget* parent) { return new GalleryPanel(services, parent); }};
}

GalleryPanel::GalleryPanel(Services& services, QWidget* parent)
    : QWidget(parent), m_services(services),
      m_group(named(new QComboBox(this), "galleryGroup", tr("Which presets are listed"))),
      m_take(named(new QComboBox(this), "galleryTake",
                   tr("What is taken of a preset: everything, its colours under the present opacities,\n"
                      "or its opacities in the present colours"))),
      m_list(named(new QListWidget(this), "galleryList", tr("Presets, drawn with this volume"))),
      m_keep(named(toolButton(tr("Save as preset…"), this), "galleryKeep",
                   tr("Keeps the present transfer function, with its opacities, as a preset of your own"))),
      m_remove(named(toolButton(tr("Remove"), this), "galleryRemove",
                     tr("Removes the selected preset, if it is one of your own"))),
      m_wait(kWait, [this] { draw(); }), m_renderer(std::make_shared<KeptRenderer>()),
      m_job(
          [this, renderer = m_renderer](const Task& task, const JobControl& job) {
              PictureInput picture = task.picture;
              for (std::size_t i = 0; i < task.tfs.size(); ++i) {
                  picture.tf = task.tfs[i];
                  const Image image = renderer->render(picture, {job.stop, {}});
                  m_job.post([this, number = task.number, i, picture = qImageFromImage(image)] {
                      showPicture(number, static_cast<int>(i), picture);
                  });
              }
              return task.number;
          },
          [](const Task&, int&) {}) {
    setObjectName("galleryPanel");
    m_group->setAccessibleName(tr("Presets listed"));
    m_take->setAccessibleName(tr("What is taken"));
    m_list->setAccessibleName(tr("Presets"));
    m_take->addItems({tr("Apply all"), tr("Colours only"), tr("Opacities only")});
    elideInTheMiddle(*m_list);
    m_list->setViewMode(QListView::IconMode);
    m_list->setResizeMode(QListView::Adjust);
    m_list->setMovement(QListView::Static);
    m_list->setIconSize({kWidth, kHeight});
    m_list->setGridSize({kWidth + 14, kHeight + 26});
    m_list->setUniformItemSizes(true);
    m_list->setWordWrap(false);
    m_list->setContextMenuPolicy(Qt::CustomContextMenu);
    setLayout(
        inset(columnOf({rowOf({{m_group, 1}, {m_take, 1}}), {m_list, 1}, rowOf({m_keep, m_remove, Cell::rest()})}),
              {8, 8, 8, 8}));

    connect(m_group, &QComboBox::activated, this, &GalleryPanel::fill);
    for (const auto signal : {&QListWidget::itemActivated, &QListWidget::itemClicked})
        connect(m_list, signal, this, [this](QListWidgetItem* item) { apply(m_list->row(item)); });
    connect(m_list, &QListWidget::customContextMenuRequested, this, &GalleryPanel::showMenu);
    connect(m_list, &QListWidget::currentRowChanged, this, [this](int row) {
        const Entry* const entry = entryAt(row);
        m_remove->setEnabled(entry != nullptr && !entry->path.isEmpty());
    });
    connect(m_keep, &QToolButton::clicked, this, &GalleryPanel::keep);
    connect(m_remove, &QToolButton::clicked, this, &GalleryPanel::remove);
    connect(&services.store(), &SessionStore::changed, this, &GalleryPanel::follow);
    connect(&services.panels(), &Panels::visibilityChanged, this, [this](const QString& id, bool visible) {
        if (id == "gallery") setShown(visible);
    });
    connect(&services, &Services::readOnlyChanged, this, [this] { m_list->setEnabled(!m_services.isReadOnly()); });
    fill();
}

const GalleryPanel::Entry* GalleryPanel::entryAt(int row) const {
    const auto at = static_cast<std::size_t>(row);
    return row >= 0 && at < m_entries.size() ? &m_entries[at] : nullptr;
}

QString GalleryPanel::presetFolder() {
    return QStandardPaths::writableLocation(QStandardPaths::AppDataLocation) + "/presets";
}

void GalleryPanel::setShown(bool shown) {
    m_shown = shown;
    if (!shown) m_renderer->release();
    if (shown && m_stale) draw();
}

void GalleryPanel::follow(const Scene& before, const Scene& after) {
    m_keep->setEnabled(after.volume != nullptr);
    if (before.volume != after.volume) m_renderer->release();
    if (m_stale && !m_shown) return; // it is drawn anew when it is shown
    const auto look = [](const Scene& scene) {
        PictureInput input = pictureInput(scene, kWidth, kHeight);
        input.tf = {}; // each entry has its own
        return input;
    };
    if (before.volume == nullptr || after.volume == nullptr || !(look(before) == look(after))) drawSoon();
}

void GalleryPanel::fill() {
    std::vector<Entry> all;
    for (const TfPreset& preset : tfPresets()) all.push_back({preset, {}});
    for (const TfPreset& preset : thesisPresets()) all.push_back({preset, {}});
    const QDir folder(presetFolder());
    for (const QFileInfo& file : folder.entryInfoList({"*.tf.json"}, QDir::Files, QDir::Name)) {
        try {
            TfPreset preset = readPreset(file.filePath().toStdString());
            preset.group = tr("My own").toStdString();
            all.push_back({std::move(preset), file.filePath()});
        } catch (const Error& error) { // one broken file is no reason to do without the others
            m_services.notices().add({QString::fromUtf8(error.what()), {}});
        }
    }

    const QString wanted = m_group->currentText();
    QStringList groups{tr("All presets")};
    for (const Entry& entry : all)
        if (const QString group = QString::fromStdString(entry.preset.group); !groups.contains(group)) groups << group;
    m_group->clear();
    m_group->addItems(groups);
    m_group->setCurrentIndex(std::max(0, static_cast<int>(groups.indexOf(wanted))));

    m_list->clear();
    m_entries.clear();
    QPixmap empty(kWidth, kHeight);
    empty.fill(theme::kPanel);
    for (Entry& entry : all) {
        const QString group = QString::fromStdString(entry.preset.group);
        if (m_group->currentIndex() > 0 && group != m_group->currentText()) continue;
        auto* item = new QListWidgetItem(QIcon(empty), QString::fromStdString(entry.preset.title), m_list);
        QString tip = QStringLiteral("%1: %2").arg(group, QString::fromStdString(entry.preset.title));
        if (!entry.preset.about.empty()) tip += "\n" + QString::fromStdString(entry.preset.about);
        if (!entry.preset.tf.range) tip += "\n" + tr("Relative to the range of values");
        item->setToolTip(tip);
        m_entries.push_back(std::move(entry));
    }
    m_remove->setEnabled(false);
    drawSoon();
}

void GalleryPanel::drawSoon() {
    m_stale = true;
    if (m_shown) m_wait.start();
}

void GalleryPanel::draw() {
    if (!m_shown || !m_services.store().hasVolume()) return;
    m_stale = false;
    const Scene& scene = m_services.store().committed();
    Task task;
    const double density = devicePixelRatioF();
    task.picture = pictureInput(scene, static_cast<int>(kWidth * density), static_cast<int>(kHeight * density));
    task.picture.settings.stepInD0 = 1;
    task.picture.settings.finestInD0.reset();
    task.picture.settings.onlyFeature = -1;
    for (const Entry& entry : m_entries) task.tfs.push_back(shownTf(placed(entry.preset.tf, scene.volume->range())));
    task.number = ++m_number;
    m_job.start(std::move(task), tr("the presets"));
}

void GalleryPanel::showPicture(int number, int row, const QImage& image) {
    if (number != m_number || row >= m_list->count()) return;
    QPixmap pixmap = QPixmap::fromImage(image);
    pixmap.setDevicePixelRatio(devicePixelRatioF());
    m_list->item(row)->setIcon(QIcon(pixmap));
}

void GalleryPanel::apply(int row) {
    SessionStore& store = m_services.store();
    const Entry* const entry = entryAt(row);
    if (entry == nullptr || !m_services.isEditable()) return;
    store.commit();
    const auto what = static_cast<Take>(m_take->currentIndex());
    const TransferFunction tf =
        taken(m_services.scene().tf, placed(entry->preset.tf, m_services.scene().volume->range()), what);
    const QString title = QString::fromStdString(entry->preset.title);
    editTf(store, tf, tr("Preset %1").arg(title));
    const bool empty = what != Take::Colors && !entry->preset.tf.points.empty() && tf.points.empty();
    Q_EMIT m_services.message(empty ? tr("Preset %1 shows values that this volume does not have.").arg(title)
                                    : tr("Preset %1.").arg(title));
}

void GalleryPanel::keep() {
    if (!m_services.store().hasVolume()) return;
    bool ok = false;
    const QString title =
        QInputDialog::getText(this, tr("Keep as a preset"), tr("Name:"), QLineEdit::Normal, {}, &ok).trimmed();
    if (!ok || title.isEmpty()) return;
    const QString path = presetFolder() + "/" + fileNameOf(title);
    if (QFile::exists(path) &&
        QMessageBox::question(this, tr("Keep as a preset"), tr("There is a preset of this name. Replace it?")) !=
            QMessageBox::Yes)
        return;
    try {
        if (!QDir().mkpath(presetFolder()))
            throw FileError("cannot create the folder of presets", presetFolder().toStdString(),
                            "check its permissions");
        TransferFunction tf = m_services.scene().tf;
        for (Feature& f : tf.features) f.id = 0; // that is the session's
        writePreset(tf, title.toStdString(), path.toStdString());
    } catch (const Error& error) {
        return m_services.showError(tr("The preset cannot be kept"), error);
    }
    fill();
}

void GalleryPanel::remove() {
    const Entry* const entry = entryAt(m_list->currentRow());
    if (entry == nullptr || entry->path.isEmpty()) return;
    if (!QFile::moveToTrash(entry->path) && !QFile::remove(entry->path))
        return m_services.showError(
            tr("The preset cannot be removed"),
            FileError("the file cannot be deleted", entry->path.toStdString(), "check its permissions"));
    fill();
}

void GalleryPanel::showMenu(const QPoint& at) {
    const int row = m_list->row(m_list->itemAt(at));
    if (row < 0) return;
    m_list->setCurrentRow(row);
    QMenu menu(this);
    menu.setObjectName("galleryMenu");
    menu.addAction(tr("Apply"), this, [this, row] { apply(row); });
    if (m_remove->isEnabled()) menu.addAction(tr("Remove"), this, &GalleryPanel::remove);
    menu.exec(m_list->viewport()->mapToGlobal(at));
}

} // namespace pellucid::gui
