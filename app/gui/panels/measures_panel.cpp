// The panel of what people have measured: distances, angles, and the values in spheres and boxes.
#include <array>

#include <QHeaderView>
#include <QKeyEvent>
#include <QTreeWidget>

#include "controllers/controllers.h"
#include "jobs/rest_timer.h"
#include "panels/panel.h"
#include "panels/panel_parts.h"
#include "panels/setting_rows.h"
#include "widgets/controls.h"
#include "widgets/elided.h"
#include "widgets/layouts.h"
#include "widgets/number_text.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr int kNumber = Qt::UserRole; ///< of a row's measure
enum Column { kName, kKind, kValue };

const char* const kKinds[] = {QT_TR_NOOP("Distance"), QT_TR_NOOP("Angle"), QT_TR_NOOP("Sphere"), QT_TR_NOOP("Box")};

/// The button of a menu's entry, which looks as that does.
QToolButton* buttonOf(Services& services, const QString& action, const QString& id, QWidget* parent) {
    auto* const button = named(new QToolButton(parent), id);
    button->setDefaultAction(services.actions().findChild<QAction*>(action));
    button->setToolButtonStyle(Qt::ToolButtonTextOnly);
    button->setFocusPolicy(Qt::TabFocus); // a click leaves the keys to the picture
    return button;
}

class MeasuresPanel : public QWidget {
public:
    MeasuresPanel(Services& services, RulerController& rulers, QWidget* parent);

protected:
    bool eventFilter(QObject* watched, QEvent* event) override;

private:
    void makeList();
    void follow();
    void fillList();
    void fillRow(QTreeWidgetItem& item, const Ruler& ruler) const;
    QString placesOf(const Ruler& ruler) const;
    void itemChanged(QTreeWidgetItem* item);
    int currentNumber() const;
    void rename();

    Services& m_services;
    RulerController& m_rulers;
    QTreeWidget* m_list = named(new QTreeWidget(this), "measureList", tr("Measures of the picture and the slices"));
    QLabel* m_hint = wrappedLabel("measureHint", this);
    QToolButton* m_remove =
        named(toolButton(tr("Remove"), this), "removeMeasure", tr("Remove the selected measure (Delete)"));
    QToolButton* m_export = buttonOf(m_services, "saveMeasuresAction", "exportMeasures", this);
};

MeasuresPanel::MeasuresPanel(Services& services, RulerController& rulers, QWidget* parent)
    : QWidget(parent), m_services(services), m_rulers(rulers) {
    setObjectName("measuresPanel");
    m_list->setAccessibleName(tr("Measures"));
    m_hint->setTextFormat(Qt::PlainText);
    makeFaint(*m_hint);
    m_export->defaultAction()->setIconText(tr("Export…")); // what the button says
    auto* const kinds = rowOf({}, 4);
    for (const auto& [action, id] : {std::pair{"measureDistanceAction", "measureDistance"},
                                     {"measureAngleAction", "measureAngle"},
                                     {"measureSphereAction", "measureSphere"},
                                     {"measureBoxAction", "measureBox"}})
        kinds->addWidget(buttonOf(services, action, id, this));
    kinds->addStretch(1);
    auto* const form = new QFormLayout;
    auto* const rows = new SettingRows(services, *form, settingPart<CoordinateSettings>(&Session::coordinates));
    makeList();
    // The form's rows belong to this widget only once it is laid out.
    setLayout(inset(columnOf({kinds, m_hint, {m_list, 1}, form, rowOf({m_remove, m_export, Cell::rest()})}, 5),
                    {6, 6, 6, 6}));
    rows->add("axes", {.id = "coordinates"});

    connect(m_remove, &QToolButton::clicked, this, [this] { m_rulers.remove(currentNumber()); });
    connect(&rulers, &RulerController::changed, this, &MeasuresPanel::follow);
    connect(&services, &Services::readOnlyChanged, this, &MeasuresPanel::follow);
    connect(&services.store(), &SessionStore::changed, this, [this](const Scene& before, const Scene& after) {
        if (before.volume != after.volume) follow();
    });
    follow();
}

void MeasuresPanel::makeList() {
    m_list->setRootIsDecorated(false);
    m_list->setHeaderLabels({tr("Name"), tr("Kind"), tr("Value")});
    const QString tips[] = {
        tr("Unchecked measures are hidden in picture and slices. F2 renames, Delete removes."), tr("What is measured"),
        tr("Lengths are in the unit of the volume (mm for patient data), angles in degrees, values in\n"
           "data units, mean ± standard deviation (by n) of the voxels whose centres lie in\n"
           "the sphere or box. Clipping and transfer function do not count.")};
    for (int column = 0; column <= kValue; ++column) m_list->headerItem()->setToolTip(column, tips[column]);
    m_list->header()->setStretchLastSection(true);
    m_list->header()->setSectionResizeMode(kName, QHeaderView::ResizeToContents);
    m_list->header()->setSectionResizeMode(kKind, QHeaderView::ResizeToContents);
    m_list->setEditTriggers(QAbstractItemView::NoEditTriggers);
    elideInTheMiddle(*m_list);
    m_list->installEventFilter(this);
    connect(m_list, &QTreeWidget::itemChanged, this, &MeasuresPanel::itemChanged);
    connect(m_list, &QTreeWidget::itemDoubleClicked, this, &MeasuresPanel::rename);
    connect(m_list, &QTreeWidget::currentItemChanged, this, [this] { m_rulers.select(currentNumber()); });
}

int MeasuresPanel::currentNumber() const {
    const QTreeWidgetItem* const item = m_list->currentItem();
    return item == nullptr ? 0 : item->data(kName, kNumber).toInt();
}

QString MeasuresPanel::placesOf(const Ruler& ruler) const {
    const Geometry& geometry = m_services.scene().data->geometry();
    const PatientAxes axes = m_services.scene().session.coordinates->axes;
    QStringList places;
    for (const Vec3& p : ruler.points) places << tr("at %1").arg(placeText(geometry, axes, p));
    QString text = places.join('\n');
    if (ruler.kind == RulerKind::Sphere)
        text +=
            tr("\nradius %1 %2").arg(numberText(ruler.radius, ruler.radius), QString::fromUtf8(lengthUnit(geometry)));
    return text;
}

void MeasuresPanel::fillRow(QTreeWidgetItem& item, const Ruler& ruler) const {
    const QString value = m_rulers.textOf(ruler);
    item.setData(kName, kNumber, ruler.number);
    item.setText(kName, QString::fromStdString(ruler.name));
    item.setText(kKind, tr(kKinds[static_cast<std::size_t>(ruler.kind)]));
    // Of values what fits; the tool tip has all.
    const bool ofValues = ruler.kind == RulerKind::Sphere || ruler.kind == RulerKind::Box;
    item.setText(kValue, ofValues ? m_rulers.labelOf(ruler) : value);
    item.setCheckState(kName, ruler.shown ? Qt::Checked : Qt::Unchecked);
    item.setFlags(item.flags() | Qt::ItemIsUserCheckable | Qt::ItemIsEditable);
    for (int column = 0; column <= kValue; ++column)
        item.setToolTip(column, QString::fromStdString(ruler.name) + "\n" + value + "\n" + placesOf(ruler));
}

void MeasuresPanel::follow() {
    const bool ready = m_services.isEditable();
    m_list->setEnabled(ready);
    const bool hasVolume = m_services.store().hasVolume();
    if (hasVolume) fillList();
    m_remove->setEnabled(ready && m_rulers.find(m_rulers.selected()) != nullptr);
    const bool isEmpty = !hasVolume || m_services.scene().session.rulers->empty();
    m_hint->setText(m_rulers.placing() ? m_rulers.hint()
                    : isEmpty          ? tr("Choose what to measure, then click in the picture or in a slice.")
                              : tr("Drag ends, centres, rims and faces in the picture or in slices to change them."));
}

/// Rows stay where they are, so that one that is being edited goes on.
void MeasuresPanel::fillList() {
    const QSignalBlocker quiet(m_list);
    const std::vector<Ruler>& rulers = *m_services.scene().session.rulers;
    while (m_list->topLevelItemCount() > static_cast<int>(rulers.size()))
        delete m_list->takeTopLevelItem(m_list->topLevelItemCount() - 1);
    while (m_list->topLevelItemCount() < static_cast<int>(rulers.size())) m_list->addTopLevelItem(new QTreeWidgetItem);
    QTreeWidgetItem* selected = nullptr;
    for (std::size_t n = 0; n < rulers.size(); ++n) {
        QTreeWidgetItem* const item = m_list->topLevelItem(static_cast<int>(n));
        fillRow(*item, rulers[n]);
        if (rulers[n].number == m_rulers.selected()) selected = item;
    }
    m_list->setCurrentItem(selected);
}

void MeasuresPanel::itemChanged(QTreeWidgetItem* item) {
    const int number = item->data(kName, kNumber).toInt();
    const Ruler* const ruler = m_rulers.find(number);
    if (ruler == nullptr) return;
    const bool shown = item->checkState(kName) == Qt::Checked;
    const QString name = item->text(kName);
    // Later: the rows are filled anew by it, and this is called from inside the list.
    later(this, [this, number, shown, name] {
        const Ruler* const now = m_rulers.find(number);
        if (now == nullptr) return;
        if (now->shown != shown) m_rulers.setShown(number, shown);
        if (QString::fromStdString(now->name) != name) m_rulers.rename(number, name);
        follow(); // a name of spaces goes back
    });
}

void MeasuresPanel::rename() {
    QTreeWidgetItem* const item = m_list->currentItem();
    if (item != nullptr && m_services.isEditable()) m_list->editItem(item, kName);
}

bool MeasuresPanel::eventFilter(QObject* watched, QEvent* event) {
    if (watched != m_list || event->type() != QEvent::KeyPress) return QWidget::eventFilter(watched, event);
    switch (static_cast<QKeyEvent*>(event)->key()) {
    case Qt::Key_F2:
        rename();
        return true;
    case Qt::Key_Delete:
        m_rulers.remove(currentNumber());
        return true;
    case Qt::Key_Escape:
        if (!m_rulers.placing()) break;
        m_rulers.giveUp();
        return true;
    default:
        break;
    }
    return QWidget::eventFilter(watched, event);
}

} // namespace

PanelInfo measuresPanel() {
    return {.id = "measures",
            .title = QObject::tr("Measures"),
            .visible = false,
            .tabOf = "display",
            .keys = QKeySequence("Ctrl+M"),
            .tip = QObject::tr("Distances, angles, and the values in spheres and boxes"),
            .make = [](Services& services, Controllers& controllers, QWidget* parent) {
                QObject::connect(&controllers.rulers, &RulerController::placingChanged, &services,
                                 [&services, &rulers = controllers.rulers] {
                                     if (rulers.placing()) services.panels().show("measures");
                                 });
                return new MeasuresPanel(services, controllers.rulers, parent);
            }};
}

} // namespace pellucid::gui
