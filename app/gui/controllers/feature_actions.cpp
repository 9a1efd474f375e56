#include "controllers/feature_actions.h"

#include <algorithm>

#include <QMenu>
#include <QPainter>
#include <QToolButton>
#include <QWidgetAction>

#include "controllers/target_actions.h"
#include "services/services.h"
#include "store/edits.h"
#include "tf/color_maps.h"
#include "tf/shapes.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr double kNewWidth = 1.0 / 8;                // of a shape that is added
constexpr QSize kStrip{84, 14}, kSwatchSize{16, 16}; // of a map: beside its name; in a menu of the bar

struct ShapeText {
    ShapeKind kind;
    const char *id, *text, *tip;
};
constexpr ShapeText kShapes[] = {
    {ShapeKind::Tent, "addTent", QT_TR_NOOP("&Tent"), QT_TR_NOOP("Rises to one value and falls again")},
    {ShapeKind::Trapezoid, "addTrapezoid", QT_TR_NOOP("Tra&pezoid"), QT_TR_NOOP("A plateau between two slopes")},
    {ShapeKind::Gaussian, "addGaussian", QT_TR_NOOP("&Gaussian"),
     QT_TR_NOOP("A bell, in chords that lie within 0.5 % of it")},
    {ShapeKind::Ramp, "addRamp", QT_TR_NOOP("&Ramp"), QT_TR_NOOP("Rises evenly, and ends by a step")},
    {ShapeKind::Step, "addStep", QT_TR_NOOP("&Step"), QT_TR_NOOP("The same opacity everywhere, between two steps")},
};

/// One step; what cannot be done is said in the status line.
template <class Change>
void tryEdit(Services& services, const QString& text, const Change& change) {
    try {
        services.store().commit();
        editTf(services.store(), change(services.scene().tf), text);
    } catch (const Error& e) {
        Q_EMIT services.message(
            QStringLiteral("%1: %2; %3")
                .arg(text, QString::fromStdString(e.problem()), QString::fromStdString(e.whatToDo())));
    }
}

void select(Services& services, int feature) {
    const auto& features = services.scene().tf.features;
    const auto f = static_cast<std::size_t>(feature);
    services.selection().setFeature(feature >= 0 && f < features.size() ? features[f].id : 0);
}

/// An edit that makes a feature, which is selected then.
template <class Change>
void tryAdd(Services& services, const QString& text, const Change& change) {
    int index = -1;
    tryEdit(services, text, [&](const TransferFunction& tf) {
        AddedFeature added = change(tf);
        index = added.index;
        return added.tf;
    });
    if (index >= 0) select(services, index);
}

void addShape(Services& services, ShapeKind kind) {
    tryAdd(services, QObject::tr("Add %1").arg(QString::fromStdString(name(kind))), [&](const TransferFunction& tf) {
        const Feature* const selected = services.selected();
        const double near = selected == nullptr ? 0.5 : (selected->a + selected->b) / 2;
        const ValueRange room = roomFor(tf, kNewWidth, near);
        Shape shape;
        shape.kind = kind;
        shape.a = room.lo;
        shape.b = room.hi;
        // As high as the others are in the middle: neither lost among them nor hiding them.
        std::vector<double> peaks = featureOpacities(tf);
        if (!peaks.empty()) {
            const auto middle = peaks.begin() + static_cast<std::ptrdiff_t>(peaks.size() / 2);
            std::nth_element(peaks.begin(), middle, peaks.end());
            shape.peak = *middle > 0 ? *middle : kDefaultPeak;
        }
        std::vector<Rgb> present;
        for (const Feature& f : tf.features) present.push_back(f.color);
        shape.color = colorApartFrom(present);
        return withShapeAdded(tf, shape);
    });
}

void split(Services& services, int feature) {
    tryEdit(services, QObject::tr("Split feature"), [&](const TransferFunction& tf) {
        const Feature& f = tf.features[static_cast<std::size_t>(feature)];
        const std::optional<double> pointed = services.selection().hoveredIntensity();
        const auto& histogram = services.scene().histogram;
        const std::span<const std::uint64_t> counts =
            histogram ? std::span<const std::uint64_t>(histogram->counts) : std::span<const std::uint64_t>();
        const bool points = pointed && *pointed > f.a && *pointed < f.b;
        return withFeatureSplit(tf, feature, points ? *pointed : splitPlace(f, counts), counts);
    });
}

void merge(Services& services, int feature) {
    const TransferFunction& tf = services.scene().tf;
    const int lower = nextFeature(tf, feature) >= 0 ? feature : previousFeature(tf, feature);
    if (lower < 0) return;
    tryAdd(services, QObject::tr("Merge features"),
           [&](const TransferFunction& now) { return withFeaturesMerged(now, lower); });
}

void duplicate(Services& services, int feature) {
    tryAdd(services, QObject::tr("Duplicate feature"),
           [&](const TransferFunction& tf) { return withFeatureDuplicated(tf, feature); });
}

void remove(Services& services, int feature) {
    tryEdit(services, QObject::tr("Remove feature"),
            [&](const TransferFunction& tf) { return withFeatureRemoved(tf, feature); });
    select(services, std::min(feature, static_cast<int>(services.scene().tf.features.size()) - 1));
}

void showOrHide(Services& services, int feature) {
    const bool hidden = services.selected()->hidden;
    tryEdit(services, hidden ? QObject::tr("Show feature") : QObject::tr("Hide feature"),
            [&](const TransferFunction& tf) { return withFeatureHidden(tf, feature, !hidden); });
}

void changeKind(Services& services, int feature, ShapeKind kind) {
    tryEdit(services, QObject::tr("Change shape"),
            [&](const TransferFunction& tf) { return withFeatureKind(tf, feature, kind); });
}

void hideOthers(Services& services, int feature) {
    tryEdit(services, QObject::tr("Hide other features"),
            [&](const TransferFunction& tf) { return withOthersHidden(tf, feature); });
}

/// What is done to the selected feature.
struct FeatureText {
    const char *id, *text, *keys, *tip;
    void (*act)(Services& services, int feature);
};
constexpr FeatureText kShaping[] = {
    {"featureSplit", QT_TR_NOOP("&Split"), "Ctrl+Shift+X",
     QT_TR_NOOP("Makes two features of the selected one: in the deepest valley of the histogram within it, else in\n"
                "its middle; with the mouse over the curve, there. The picture stays but for the new one's colour"),
     split},
    {"featureMerge", QT_TR_NOOP("&Merge with the next"), "Ctrl+Shift+M",
     QT_TR_NOOP("Makes one feature of the selected one and the next by value (of the last one and the one before)"),
     merge},
    {"featureDuplicate", QT_TR_NOOP("&Duplicate"), "Ctrl+Shift+D",
     QT_TR_NOOP("Puts a copy in the nearest gap between features"), duplicate},
    {"featureRemove", QT_TR_NOOP("R&emove"), "Ctrl+Delete",
     QT_TR_NOOP("Removes the selected feature, and what it makes opaque"), remove},
};

QString featureMenu() { return QObject::tr("&Transfer function") + "/" + QObject::tr("Feat&ure"); }

/// The colours of a map from left to right.
QPixmap colorStrip(const ColorMap& map, const QSize& size) {
    QPixmap strip(size);
    QPainter painter(&strip);
    for (int x = 0; x < size.width(); ++x)
        painter.fillRect(x, 0, 1, size.height(), colorFromRgb(colorOf(map, (x + 0.5) / size.width())));
    return strip;
}

} // namespace

void FeatureActions::toggleOnly(int feature) {
    SessionStore& store = m_services.store();
    const auto& features = store.scene().tf.features;
    if (feature < 0 || static_cast<std::size_t>(feature) >= features.size()) return;
    const FeatureId id = store.scene().onlyFeature() == feature ? 0 : features[static_cast<std::size_t>(feature)].id;
    store.commit();
    editPart(store, &Session::display,
             id == 0 ? QObject::tr("Draw all features") : QObject::tr("Draw only this feature"), {},
             [&](DisplaySettings& d) { d.onlyFeature = id; });
}

void FeatureActions::addPresets() {
    Services& services = m_services;
    const auto editable = [&services] { return services.isEditable(); };
    ActionMenu menu(services.actions(), QObject::tr("&Transfer function"), editable),
        presets(services.actions(), QObject::tr("&Transfer function") + "/" + QObject::tr("&Presets"), editable);
    for (const char* spec : {"tents:1", "tents:2", "tents:3", "tents:4", "tents:6", "tents:8", "ramp:6", "ramp:12"}) {
        const QString name = QString::fromLatin1(spec), number = name.section(':', 1);
        const QString text = name.startsWith("ramp") ? QObject::tr("Ramp of %1 points, one feature").arg(number)
                             : number == "1"         ? QObject::tr("One tent, one feature")
                                                     : QObject::tr("%1 tents, one feature each").arg(number);
        presets.add(name, text, {}, {},
                    [&services, name] { editTf(services.store(), *tfFromSpec(name.toStdString()), name); });
    }
    menu.separate();
    menu.add("deriveFeaturesAction", QObject::tr("&Features from the curve"), {},
             QObject::tr("One feature for each interval of the curve between two points of opacity 0"), [&services] {
                 TransferFunction tf = services.scene().tf;
                 tf.features = deriveFeatures(tf);
                 editTf(services.store(), tf, QObject::tr("Features from the curve"));
             });
}

void FeatureActions::addColorActions() {
    Services& services = m_services;
    ActionMenu menu(services.actions(), QObject::tr("&Transfer function") + "/" + QObject::tr("&Colours"),
                    [&services] { return services.isEditable(); });
    const auto overFeatures = std::make_shared<bool>(false); // how the next map is applied; no part of any state
    for (const ColorMap& map : colorMaps()) {
        const auto apply = [&services, &map, overFeatures] {
            tryEdit(services, QObject::tr("Colours: %1").arg(QString::fromStdString(map.name)),
                    [&](const TransferFunction& tf) {
                        ColorMapOptions options;
                        options.overFeatures = *overFeatures;
                        return withColorMap(tf, map, options);
                    });
        };
        QAction* const action = menu.add(
            "colorMap-" + QString::fromStdString(map.name), QString::fromStdString(map.title), {},
            map.visionSafe ? QObject::tr("Colours by value; colour-blind eyes can tell them apart too. Opacities stay")
                           : QObject::tr("Colours by value; opacities stay"),
            apply);
        action->setIcon(colorStrip(map, kSwatchSize));
        action->setIconVisibleInMenu(true);
        m_maps << action;
    }
    menu.separate();
    m_colors << menu.addCheck(
        "colorsOverFeatures", QObject::tr("&One colour per feature"), {},
        QObject::tr("The next map gives each feature one colour, in the order of their values,\n"
                    "instead of a colour to every value"),
        [overFeatures] { return *overFeatures; }, [overFeatures] { *overFeatures = !*overFeatures; });
    menu.separate();
    m_colors << menu.add("colorsReverse", QObject::tr("&Reverse"), {},
                         QObject::tr("Gives low values the colours of high ones, and the reverse. Opacities stay"),
                         [&services] { tryEdit(services, QObject::tr("Reverse colours"), withColorsReversed); });
    m_colors << menu.add("colorsInvert", QObject::tr("&Invert"), {},
                         QObject::tr("Makes light colours dark and dark ones light, of the same hue. Opacities stay"),
                         [&services] { tryEdit(services, QObject::tr("Invert colours"), withColorsInverted); });
}

void FeatureActions::addActions() {
    Services& services = m_services;
    Actions& actions = services.actions();
    const auto editable = [&services] { return services.isEditable(); };
    const auto selected = [&services, editable] { return editable() && services.selected() != nullptr; };
    addPresets();
    ActionMenu add(actions, featureMenu() + "/" + QObject::tr("&Add"), editable),
        menu(actions, featureMenu(), selected),
        changeTo(actions, featureMenu() + "/" + QObject::tr("&Change to"), selected);
    for (const ShapeText& shape : kShapes)
        m_shapes << add.add(shape.id, QObject::tr(shape.text), {}, QObject::tr(shape.tip),
                            [&services, kind = shape.kind] { addShape(services, kind); });
    menu.separate();
    for (const FeatureText& entry : kShaping)
        m_shaping << menu.add(entry.id, QObject::tr(entry.text), entry.keys, QObject::tr(entry.tip),
                              toSelected(services, entry.act));
    for (const ShapeText& shape : kShapes)
        m_kinds << changeTo.add(
            "featureAs-" + QString::fromStdString(name(shape.kind)), QObject::tr(shape.text), {},
            QObject::tr("The same values, peak and colour in another shape"),
            toSelected(services, [kind = shape.kind](Services& s, int f) { changeKind(s, f, kind); }));
    menu.separate();
    m_showing << menu.addCheck(
        "featureShow", QObject::tr("S&hown"), "H",
        QObject::tr("The eye of the selected feature: a hidden one is neither drawn nor measured"),
        [&services] { return services.selected() == nullptr || !services.selected()->hidden; },
        toSelected(services, showOrHide));
    m_showing << menu.addCheck(
        "featureOnly", QObject::tr("&Draw only this"), "Shift+H",
        QObject::tr("The picture shows the selected feature alone; figures stay those of all"),
        [&services] { return services.selected() && services.scene().onlyFeature() == services.selectedFeature(); },
        [this] { toggleOnly(m_services.selectedFeature()); });
    m_showing << menu.add("featureHideOthers", QObject::tr("Hide &others"), {},
                          QObject::tr("Close the eyes of all other features: picture and figures are of this one"),
                          toSelected(services, hideOthers));
    m_showing << menu.add("featureShowAll", QObject::tr("Show &all"), {}, QObject::tr("Open the eyes of all features"),
                          [&services] { tryEdit(services, QObject::tr("Show all features"), withAllShown); },
                          {.enabled = [&services, editable] {
                              const auto& features = services.scene().tf.features;
                              return editable() && std::any_of(features.begin(), features.end(),
                                                               [](const Feature& f) { return f.hidden; });
                          }});
    addColorActions();

    QObject::connect(&services.selection(), &Selection::featureChanged, &actions, &Actions::refresh);
}

void FeatureActions::fillMenu(QMenu& menu) const {
    menu.setToolTipsVisible(true);
    menu.addActions(m_showing);
    menu.addSeparator();
    menu.addActions(m_shaping);
    menu.addMenu(QObject::tr("&Change to"))->addActions(m_kinds);
    menu.addSeparator();
    menu.addActions(m_targets.limits());
    menu.addSeparator();
    menu.addMenu(QObject::tr("&Add"))->addActions(m_shapes);
}

void FeatureActions::fillColorMenu(QMenu& menu) const {
    menu.setToolTipsVisible(true);
    for (qsizetype i = 0; i < m_maps.size(); ++i) { // menus draw icons as small squares; these are strips
        QAction* const action = m_maps[i];
        auto* entry = new QWidgetAction(&menu);
        entry->setObjectName(action->objectName());
        auto* strip = new QToolButton(&menu);
        strip->setIcon(colorStrip(colorMaps()[static_cast<std::size_t>(i)], kStrip));
        strip->setIconSize(kStrip);
        strip->setText(QStringLiteral("  ") + action->text());
        strip->setToolTip(action->toolTip());
        strip->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
        strip->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
        strip->setAutoRaise(true);
        entry->setDefaultWidget(strip);
        QObject::connect(strip, &QToolButton::clicked, &menu, [&menu, entry] {
            menu.close();
            entry->trigger();
        });
        QObject::connect(entry, &QAction::triggered, action, &QAction::trigger);
        menu.addAction(entry);
    }
    menu.addSeparator();
    menu.addActions(m_colors);
}

} // namespace pellucid::gui
