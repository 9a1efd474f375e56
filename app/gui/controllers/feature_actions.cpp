#include "controllers/feature_actions.h"

#include <algorithm>

#include <QMenu>
#include <QPainter>
#include <QToolButton>
#include <QWidgetAction>

#include "controllers/target_actions.h"
#include "services/workbench.h"
#include "store/edits.h"
#include "tf/shapes.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr double kNewWidth = 1.0 / 8;            // of a shape that is added
constexpr QSize kStrip{84, 14}, kSwatch{16, 16}; // of a map: beside its name; in a menu of the bar

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
void tryEdit(Workbench& bench, const QString& text, const Change& change) {
    try {
        bench.store().commit();
        editTf(bench.store(), change(bench.scene().tf), text);
    } catch (const Error& e) {
        Q_EMIT bench.message(QStringLiteral("%1: %2; %3")
                                 .arg(text, QString::fromStdString(e.problem()), QString::fromStdString(e.whatToDo())));
    }
}

void select(Workbench& bench, int feature) {
    const auto& features = bench.scene().tf.features;
    const auto f = static_cast<std::size_t>(feature);
    bench.selection().setFeature(feature >= 0 && f < features.size() ? features[f].id : 0);
}

/// An edit that makes a feature, which is selected then.
template <class Change>
void tryAdd(Workbench& bench, const QString& text, const Change& change) {
    int index = -1;
    tryEdit(bench, text, [&](const TransferFunction& tf) {
        AddedFeature added = change(tf);
        index = added.index;
        return added.tf;
    });
    if (index >= 0) select(bench, index);
}

void addShape(Workbench& bench, ShapeKind kind) {
    tryAdd(bench, QObject::tr("Add %1").arg(QString::fromStdString(name(kind))), [&](const TransferFunction& tf) {
        const int selected = selectedFeature(bench);
        const double near = selected < 0 ? 0.5
                                         : (tf.features[static_cast<std::size_t>(selected)].a +
                                            tf.features[static_cast<std::size_t>(selected)].b) /
                                               2;
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

void split(Workbench& bench, int feature) {
    tryEdit(bench, QObject::tr("Split feature"), [&](const TransferFunction& tf) {
        const Feature& f = tf.features[static_cast<std::size_t>(feature)];
        const std::optional<double> pointed = bench.selection().hoveredIntensity();
        const auto& histogram = bench.scene().histogram;
        const std::span<const std::uint64_t> counts =
            histogram ? std::span<const std::uint64_t>(histogram->counts) : std::span<const std::uint64_t>();
        const bool points = pointed && *pointed > f.a && *pointed < f.b;
        return withFeatureSplit(tf, feature, points ? *pointed : splitPlace(f, counts), counts);
    });
}

void merge(Workbench& bench, int feature) {
    const TransferFunction& tf = bench.scene().tf;
    const int lower = nextFeature(tf, feature) >= 0 ? feature : previousFeature(tf, feature);
    if (lower < 0) return;
    tryAdd(bench, QObject::tr("Merge features"),
           [&](const TransferFunction& now) { return withFeaturesMerged(now, lower); });
}

void remove(Workbench& bench, int feature) {
    tryEdit(bench, QObject::tr("Remove feature"),
            [&](const TransferFunction& tf) { return withFeatureRemoved(tf, feature); });
    select(bench, std::min(feature, static_cast<int>(bench.scene().tf.features.size()) - 1));
}

QString featureMenu() { return QObject::tr("&Transfer function") + "/" + QObject::tr("Feat&ure"); }
QString colorMenu() { return QObject::tr("&Transfer function") + "/" + QObject::tr("&Colours"); }

constexpr const char* kFeatureEntries[] = {"featureShow",  "featureOnly",  "featureHideOthers", "featureShowAll", "",
                                           "featureSplit", "featureMerge", "featureDuplicate",  "featureRemove"};

QString kindId(ShapeKind kind) { return QStringLiteral("featureAs-") + QString::fromStdString(name(kind)); }
QString mapId(const ColorMap& map) { return QStringLiteral("colorMap-") + QString::fromStdString(map.name); }

void addColorActions(Workbench& bench) {
    Actions& actions = bench.actions();
    const auto editable = [&bench] { return bench.store().hasVolume() && !bench.isReadOnly(); };
    const auto overFeatures = std::make_shared<bool>(false); // how the next map is applied; no part of any state
    for (const ColorMap& map : colorMaps()) {
        const ColorMap* const which = &map;
        QAction* const action = actions.add(
            {.id = mapId(map),
             .menu = colorMenu(),
             .text = QString::fromStdString(map.title),
             .tip = map.visionSafe
                        ? QObject::tr("Colours by value; told apart by colour-blind eyes too. Opacities stay")
                        : QObject::tr("Colours by value; opacities stay"),
             .trigger =
                 [&bench, which, overFeatures] {
                     tryEdit(bench, QObject::tr("Colours: %1").arg(QString::fromStdString(which->name)),
                             [&](const TransferFunction& tf) {
                                 ColorMapOptions options;
                                 options.overFeatures = *overFeatures;
                                 return withColorMap(tf, *which, options);
                             });
                 },
             .enabled = editable});
        action->setIcon(colorStrip(map, kSwatch));
        action->setIconVisibleInMenu(true);
    }
    actions.add({.id = "colorsOverFeatures",
                 .menu = colorMenu(),
                 .text = QObject::tr("&One colour per feature"),
                 .tip = QObject::tr("The next map gives each feature one colour, in the order of their values,\n"
                                    "instead of a colour to every value"),
                 .trigger = [overFeatures] { *overFeatures = !*overFeatures; },
                 .enabled = editable,
                 .checked = [overFeatures] { return *overFeatures; },
                 .separatorBefore = true});
    actions.add({.id = "colorsReverse",
                 .menu = colorMenu(),
                 .text = QObject::tr("&Reverse"),
                 .tip = QObject::tr("The colours end to end: those of high values to low ones. Opacities stay"),
                 .trigger = [&bench] { tryEdit(bench, QObject::tr("Reverse colours"), withColorsReversed); },
                 .enabled = editable,
                 .separatorBefore = true});
    actions.add({.id = "colorsInvert",
                 .menu = colorMenu(),
                 .text = QObject::tr("&Invert"),
                 .tip = QObject::tr("Light colours become dark and dark ones light, of the same hue. Opacities stay"),
                 .trigger = [&bench] { tryEdit(bench, QObject::tr("Invert colours"), withColorsInverted); },
                 .enabled = editable});
}

} // namespace

int selectedFeature(Workbench& bench) { return featureWithId(bench.scene().tf, bench.selection().feature()); }

void toggleOnlyFeature(Workbench& bench, int feature) {
    const auto& features = bench.scene().tf.features;
    if (feature < 0 || static_cast<std::size_t>(feature) >= features.size()) return;
    const FeatureId id = bench.scene().onlyFeature() == feature ? 0 : features[static_cast<std::size_t>(feature)].id;
    bench.store().commit();
    bench.store().edit(
        id == 0 ? QObject::tr("Draw all features") : QObject::tr("Draw only this feature"), {},
        [&](Session& session) { session.display.edit([&](DisplaySettings& d) { d.onlyFeature = id; }); });
}

QPixmap colorStrip(const ColorMap& map, const QSize& size) {
    QPixmap strip(size);
    QPainter painter(&strip);
    for (int x = 0; x < size.width(); ++x)
        painter.fillRect(x, 0, 1, size.height(), colorFromRgb(colorOf(map, (x + 0.5) / size.width())));
    return strip;
}

void addFeatureActions(Workbench& bench) {
    Actions& actions = bench.actions();
    const auto editable = [&bench] { return bench.store().hasVolume() && !bench.isReadOnly(); };
    const auto selected = [&bench, editable] { return editable() && selectedFeature(bench) >= 0; };
    const auto keys = [](const char* text) { return QList<QKeySequence>{QKeySequence(text)}; };

    for (const ShapeText& shape : kShapes)
        actions.add({.id = shape.id,
                     .menu = featureMenu() + "/" + QObject::tr("&Add"),
                     .text = QObject::tr(shape.text),
                     .tip = QObject::tr(shape.tip),
                     .trigger = [&bench, kind = shape.kind] { addShape(bench, kind); },
                     .enabled = editable});
    const auto add = [&](const QString& id, const QString& text, const QList<QKeySequence>& key, const QString& tip,
                         bool separator, std::function<void(int)> trigger) {
        actions.add({.id = id,
                     .menu = featureMenu(),
                     .text = text,
                     .keys = key,
                     .tip = tip,
                     .trigger =
                         [&bench, trigger = std::move(trigger)] {
                             if (const int f = selectedFeature(bench); f >= 0) trigger(f);
                         },
                     .enabled = selected,
                     .separatorBefore = separator});
    };
    add("featureSplit", QObject::tr("&Split"), keys("Ctrl+Shift+X"),
        QObject::tr("Two features of the selected one: in the deepest valley of the histogram within it, else in its\n"
                    "middle; with the mouse over the curve, there. The picture stays but for the new one's colour"),
        true, [&bench](int f) { split(bench, f); });
    add("featureMerge", QObject::tr("&Merge with the next"), keys("Ctrl+Shift+M"),
        QObject::tr("One feature of the selected one and the next by value (of the last one: the one before)"), false,
        [&bench](int f) { merge(bench, f); });
    add("featureDuplicate", QObject::tr("&Duplicate"), keys("Ctrl+Shift+D"),
        QObject::tr("A copy in the nearest gap between features"), false, [&bench](int f) {
            tryAdd(bench, QObject::tr("Duplicate feature"),
                   [&](const TransferFunction& tf) { return withFeatureDuplicated(tf, f); });
        });
    add("featureRemove", QObject::tr("R&emove"), keys("Ctrl+Delete"),
        QObject::tr("Remove the selected feature, and what it makes opaque"), false,
        [&bench](int f) { remove(bench, f); });
    for (const ShapeText& shape : kShapes)
        actions.add({.id = kindId(shape.kind),
                     .menu = featureMenu() + "/" + QObject::tr("&Change to"),
                     .text = QObject::tr(shape.text),
                     .tip = QObject::tr("The same values, peak and colour in another shape"),
                     .trigger =
                         [&bench, kind = shape.kind] {
                             const int f = selectedFeature(bench);
                             if (f >= 0)
                                 tryEdit(bench, QObject::tr("Change shape"),
                                         [&](const TransferFunction& tf) { return withFeatureKind(tf, f, kind); });
                         },
                     .enabled = selected});
    actions.add({.id = "featureShow",
                 .menu = featureMenu(),
                 .text = QObject::tr("S&hown"),
                 .keys = keys("H"),
                 .tip = QObject::tr("The eye of the selected feature: hidden, it is neither drawn nor measured"),
                 .trigger =
                     [&bench] {
                         const int f = selectedFeature(bench);
                         if (f < 0) return;
                         const bool hidden = bench.scene().tf.features[static_cast<std::size_t>(f)].hidden;
                         tryEdit(bench, hidden ? QObject::tr("Show feature") : QObject::tr("Hide feature"),
                                 [&](const TransferFunction& tf) { return withFeatureHidden(tf, f, !hidden); });
                     },
                 .enabled = selected,
                 .checked =
                     [&bench] {
                         const int f = selectedFeature(bench);
                         return f < 0 || !bench.scene().tf.features[static_cast<std::size_t>(f)].hidden;
                     },
                 .separatorBefore = true});
    actions.add({.id = "featureOnly",
                 .menu = featureMenu(),
                 .text = QObject::tr("&Draw only this"),
                 .keys = keys("Shift+H"),
                 .tip = QObject::tr("The picture shows the selected feature alone; figures stay those of all"),
                 .trigger = [&bench] { toggleOnlyFeature(bench, selectedFeature(bench)); },
                 .enabled = selected,
                 .checked =
                     [&bench] {
                         const int f = selectedFeature(bench);
                         return f >= 0 && bench.scene().onlyFeature() == f;
                     }});
    add("featureHideOthers", QObject::tr("Hide &others"), {},
        QObject::tr("Close the eyes of all other features: picture and figures are of this one"), false,
        [&bench](int f) {
            tryEdit(bench, QObject::tr("Hide other features"),
                    [&](const TransferFunction& tf) { return withOthersHidden(tf, f); });
        });
    actions.add({.id = "featureShowAll",
                 .menu = featureMenu(),
                 .text = QObject::tr("Show &all"),
                 .tip = QObject::tr("Open the eyes of all features"),
                 .trigger = [&bench] { tryEdit(bench, QObject::tr("Show all features"), withAllShown); },
                 .enabled =
                     [&bench, editable] {
                         const auto& features = bench.scene().tf.features;
                         return editable() && std::any_of(features.begin(), features.end(),
                                                          [](const Feature& f) { return f.hidden; });
                     }});
    addColorActions(bench);

    QObject::connect(&bench.selection(), &Selection::featureChanged, &actions, &Actions::refresh);
    QObject::connect(&bench.store(), &SessionStore::changed, &actions,
                     [&actions](const Scene& before, const Scene& after) {
                         const auto eyesAndIds = [](const TransferFunction& p, const TransferFunction& q) {
                             return std::equal(p.features.begin(), p.features.end(), q.features.begin(),
                                               q.features.end(), [](const Feature& f, const Feature& g) {
                                                   return f.id == g.id && f.hidden == g.hidden;
                                               });
                         };
                         if (!eyesAndIds(before.tf, after.tf) || before.onlyFeature() != after.onlyFeature())
                             actions.refresh();
                     });
}

void fillShapeMenu(QMenu& menu, Workbench& bench) {
    for (const ShapeText& shape : kShapes) menu.addAction(bench.actions().find(shape.id));
}

void fillFeatureMenu(QMenu& menu, Workbench& bench) {
    menu.setToolTipsVisible(true);
    for (const char* id : kFeatureEntries) {
        if (*id == 0)
            menu.addSeparator();
        else
            menu.addAction(bench.actions().find(id));
    }
    QMenu* const change = menu.addMenu(QObject::tr("&Change to"));
    for (const ShapeText& shape : kShapes) change->addAction(bench.actions().find(kindId(shape.kind)));
    fillLimitsMenu(menu, bench);
    menu.addSeparator();
    fillShapeMenu(*menu.addMenu(QObject::tr("&Add")), bench);
}

void fillColorMenu(QMenu& menu, Workbench& bench) {
    menu.setToolTipsVisible(true);
    for (const ColorMap& map : colorMaps()) { // menus draw icons as small squares; these are strips
        QAction* const action = bench.actions().find(mapId(map));
        auto* entry = new QWidgetAction(&menu);
        entry->setObjectName(action->objectName());
        auto* strip = new QToolButton(&menu);
        strip->setIcon(colorStrip(map, kStrip));
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
    for (const char* id : {"colorsOverFeatures", "colorsReverse", "colorsInvert"})
        menu.addAction(bench.actions().find(id));
}

} // namespace pellucid::gui
