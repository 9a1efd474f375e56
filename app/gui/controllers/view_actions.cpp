#include "controllers/menu_actions.h"

#include <QApplication>
#include <QSettings>

#include "services/services.h"
#include "store/edits.h"
#include "store/view_edits.h"
#include "widgets/shown_vision.h"

namespace pellucid::gui {
namespace {

const QString kThemeKey = QStringLiteral("theme");

/// What a standard view is called, and what one sees from there: along the file's axes, and of a patient.
struct ViewText {
    StandardView view;
    const char *file, *patient, *tip;
};
constexpr ViewText kViews[] = {
    {StandardView::Front, QT_TR_NOOP("Front"), QT_TR_NOOP("Anterior"),
     QT_TR_NOOP("From the front of the patient, whose left is at the right")},
    {StandardView::Back, QT_TR_NOOP("Back"), QT_TR_NOOP("Posterior"),
     QT_TR_NOOP("From behind the patient, whose left is at the left")},
    {StandardView::Left, QT_TR_NOOP("Left"), QT_TR_NOOP("Left"),
     QT_TR_NOOP("From the patient's left, with the front at the left")},
    {StandardView::Right, QT_TR_NOOP("Right"), QT_TR_NOOP("Right"),
     QT_TR_NOOP("From the patient's right, with the front at the right")},
    {StandardView::Top, QT_TR_NOOP("Top"), QT_TR_NOOP("Superior"),
     QT_TR_NOOP("From above the head, with the front up and the patient's left at the left")},
    {StandardView::Bottom, QT_TR_NOOP("Bottom"), QT_TR_NOOP("Inferior"),
     QT_TR_NOOP("From the feet, with the front up and the patient's left at the right, as radiologists look")},
};

struct PartText {
    const char *id, *text, *tip;
};
constexpr PartText kParts[] = {
    // in the order of kAnnotationParts
    {"frameCubeAction", QT_TR_NOOP("&Cube"),
     QT_TR_NOOP("A cube that turns with the volume: left, right, anterior, posterior, superior, inferior, or the "
                "file's axes")},
    {"frameLettersAction", QT_TR_NOOP("&Letters at the edges"),
     QT_TR_NOOP("L R A P S I: the direction that each edge of the picture lies in, where the file says how the patient "
                "lies")},
    {"frameAxesAction", QT_TR_NOOP("&Axes"), QT_TR_NOOP("The box around the volume, with coordinates")},
    {"frameScaleAction", QT_TR_NOOP("&Scale bar"), QT_TR_NOOP("A length, at the depth that the view turns about")},
    {"frameLegendAction", QT_TR_NOOP("Colour le&gend"),
     QT_TR_NOOP("Colours and opacities over the values of the data")},
    {"frameTitleAction", QT_TR_NOOP("&Title"), QT_TR_NOOP("The name of the volume")},
    {"frameMeasuresAction", QT_TR_NOOP("&Measures"),
     QT_TR_NOOP("The distances, angles, spheres and boxes of the panel Measures, in the picture and in slices")},
};
static_assert(std::size(kParts) == std::size(kAnnotationParts));

struct VisionText {
    VisionKind vision;
    const char *id, *text, *tip;
};
constexpr VisionText kVisions[] = {
    {VisionKind::Normal, "visionNormalAction", QT_TR_NOOP("&Normal"), QT_TR_NOOP("The colours as they are")},
    {VisionKind::Protanopia, "visionProtanopiaAction", QT_TR_NOOP("&Protanopia"),
     QT_TR_NOOP("Picture and panels as somebody sees them who lacks the cones for long waves: reds are dark; about one "
                "man in a hundred. What you save stays as it is")},
    {VisionKind::Deuteranopia, "visionDeuteranopiaAction", QT_TR_NOOP("&Deuteranopia"),
     QT_TR_NOOP("Picture and panels as somebody sees them who lacks the cones for middle waves: reds and greens look "
                "alike; about one man in a hundred, and five more in part. What you save stays as it is")},
    {VisionKind::Tritanopia, "visionTritanopiaAction", QT_TR_NOOP("&Tritanopia"),
     QT_TR_NOOP("Picture and panels as somebody sees them who lacks the cones for short waves: blues and greens look "
                "alike; rare. What you save stays as it is")},
    {VisionKind::Grey, "visionGreyAction", QT_TR_NOOP("&Grey"),
     QT_TR_NOOP("Picture and panels without colours, as in print. What you save stays as it is")},
};
static_assert(std::size(kVisions) == allOf<VisionKind>().size());

/// What reminds of it; empty where colours are as they are.
QString noticeOf(VisionKind vision) {
    if (vision == VisionKind::Normal) return {};
    if (vision == VisionKind::Grey)
        return QObject::tr("The window is shown without colours. Pictures are saved with them.");
    return QObject::tr("The window is shown as somebody with %1 sees it. Pictures are saved as they are.")
        .arg(QLatin1String(name(vision)));
}

bool isOfPatient(const SessionStore& store) {
    return store.hasVolume() && store.scene().volume->geometry().worldAxes == WorldAxes::Patient;
}

} // namespace

void addViewActions(Services& services) {
    SessionStore& store = services.store();
    const auto open = [&store] { return store.hasVolume(); };
    const ActionMore inToolBar{.inToolBar = true};
    ActionMenu menu(services.actions(), QObject::tr("&View"), open);
    menu.add(
        "fitAction", QObject::tr("&Fit"), "R; F",
        QObject::tr("All that is drawn, as large as it fits, from the same direction; double-click does the same"),
        [&store] { fitView(store); }, inToolBar);
    menu.add(
        "resetViewAction", QObject::tr("&Reset"), "Home",
        QObject::tr("From the side that shows most, as a volume opens; all that is drawn, as large as it fits"),
        [&store] { resetView(store); }, inToolBar);
    ActionMenu sides(services.actions(), QObject::tr("&View") + "/" + QObject::tr("&Look from"), open);
    for (const ViewText& v : kViews) {
        const QString number = QString::number(&v - kViews + 1);
        sides.add("view" + number, QObject::tr(v.file), number, {},
                  [&store, view = v.view] { setStandardView(store, view); },
                  {.say =
                       [&store, &v] {
                           return isOfPatient(store) ? QObject::tr(v.tip)
                                                     : QObject::tr("Look from this side of the file's axes");
                       },
                   .caption = [&store, &v] { return QObject::tr(isOfPatient(store) ? v.patient : v.file); },
                   .inToolBar = true});
    }
    menu.separate();
    const auto isPerspective = [&store] { return store.scene().camera.projection == Projection::Perspective; };
    menu.addCheck(
        "perspectiveAction", QObject::tr("&Perspective"), "P", QObject::tr("Perspective or parallel projection"),
        isPerspective,
        [&store, isPerspective] {
            setProjection(store, isPerspective() ? Projection::Orthographic : Projection::Perspective);
        },
        true);
    sides.separate();
    sides.add("undoViewAction", QObject::tr("&Previous view"), "Alt+Left",
              QObject::tr("Where the camera was before its last move"), [&store] { store.undoCamera(); },
              {.enabled = [&store] { return store.canUndoCamera(); }});
    sides.add("redoViewAction", QObject::tr("&Next view"), "Alt+Right", {}, [&store] { store.redoCamera(); },
              {.enabled = [&store] { return store.canRedoCamera(); }});
}

QAction& addClipHandlesAction(Services& services) {
    const auto shown = std::make_shared<bool>(false);
    ActionMenu menu(services.actions(), QObject::tr("&View") + "/" + QObject::tr("Cl&ip"),
                    [&services] { return services.store().hasVolume(); });
    return *menu.addCheck(
        "clipHandlesAction", QObject::tr("Clip &handles"), "C",
        QObject::tr("Drag the faces of the box, or a plane, to cut the volume open; with Shift the "
                    "opposite face goes along; Esc cancels"),
        [shown] { return *shown; }, [shown] { *shown = !*shown; }, true);
}

void addAnnotationActions(Services& services) {
    SessionStore& store = services.store();
    ActionMenu menu(services.actions(), QObject::tr("&View") + "/" + QObject::tr("A&nnotations"),
                    [&services] { return services.isEditable(); });
    menu.addCheck(
        "frameAction", QObject::tr("S&how annotations"), "A", QObject::tr("Show or hide all annotations"),
        [&store] { return store.session().reference->on; },
        [&store] {
            editPart(store, &Session::reference, QObject::tr("Annotations"), {},
                     [](AnnotationChoice& choice) { choice.on = !choice.on; });
        });
    menu.separate();
    for (const PartText& part : kParts) {
        const auto shown = kAnnotationParts[static_cast<std::size_t>(&part - kParts)].shown;
        const QString text = QObject::tr(part.text);
        menu.addCheck(
            part.id, text, {}, QObject::tr(part.tip), [&store, shown] { return (*store.session().reference).*shown; },
            [&store, shown, step = QString(text).remove('&')] {
                editPart(store, &Session::reference, step, {}, [&](AnnotationChoice& choice) {
                    choice.*shown = !(choice.on && choice.*shown);
                    choice.on = true;
                });
            });
    }
}

Theme keptTheme() {
    return findNamed<Theme>(QSettings().value(kThemeKey).toString().toStdString()).value_or(Theme::Dark);
}

void addThemeActions(Services& services) {
    ActionMenu menu(services.actions(), QObject::tr("&View") + "/" + QObject::tr("&Theme"));
    const auto add = [&](const char* id, const QString& text, const QString& tip, Theme theme) {
        menu.addCheck(
            id, text, {}, tip, [theme] { return appliedTheme() == theme; },
            [theme] {
                QSettings().setValue(kThemeKey, name(theme));
                applyTheme(*qApp, theme);
            });
    };
    add("themeDarkAction", QObject::tr("&Dark"), QObject::tr("Dark panels around the picture"), Theme::Dark);
    add("themeLightAction", QObject::tr("&Light"), QObject::tr("Light panels around the picture"), Theme::Light);
    add("themeSystemAction", QObject::tr("As the &system"), QObject::tr("Dark or light, as the desktop is"),
        Theme::System);
}

void addVisionActions(Services& services) {
    ActionMenu menu(services.actions(), QObject::tr("&View") + "/" + QObject::tr("Colour &vision"));
    for (const VisionText& v : kVisions)
        menu.addCheck(
            v.id, QObject::tr(v.text), {}, QObject::tr(v.tip), [&v] { return shownVision().vision() == v.vision; },
            [&v] { shownVision().show(v.vision); });
    QObject::connect(&shownVision(), &ShownVision::changed, &services, [&services, said = QString()]() mutable {
        services.notices().remove(said);
        said = noticeOf(shownVision().vision());
        if (!said.isEmpty())
            services.notices().add(
                {said, {{QObject::tr("Normal colours"), [] { shownVision().show(VisionKind::Normal); }}}});
        services.actions().refresh();
    });
}

} // namespace pellucid::gui
