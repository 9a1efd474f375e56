#include "controllers/menu_actions.h"

#include "services/services.h"

namespace pellucid::gui {
namespace {

struct Texts {
    QString id, text, tip;
};

Texts textsOf(FramePart part) {
    switch (part) {
    case FramePart::Cube:
        return {
            "frameCubeAction", QObject::tr("&Cube"),
            QObject::tr("A cube that turns with the volume: left, right, anterior, posterior, superior, inferior, or "
                        "the file's axes")};
    case FramePart::Letters:
        return {"frameLettersAction", QObject::tr("&Letters at the edges"),
                QObject::tr("L R A P S I: the direction that each edge of the picture lies in, where the file says how "
                            "the patient lies")};
    case FramePart::Axes:
        return {"frameAxesAction", QObject::tr("&Axes"), QObject::tr("The box around the volume, with coordinates")};
    case FramePart::Scale:
        return {"frameScaleAction", QObject::tr("&Scale bar"),
                QObject::tr("A length at the depth that the view turns about")};
    case FramePart::Legend:
        return {"frameLegendAction", QObject::tr("Colour le&gend"),
                QObject::tr("Colours and opacities over the values of the data")};
    case FramePart::Title:
        return {"frameTitleAction", QObject::tr("&Title"), QObject::tr("The name of the volume")};
    }
    return {};
}

} // namespace

void addAnnotationActions(Services& services) {
    SessionStore& store = services.store();
    const QString menu = QObject::tr("&View") + "/" + QObject::tr("Frame of re&ference");
    const auto editable = [&services] { return services.isEditable(); };
    services.actions().add(menu, "frameAction", QObject::tr("S&how frame of reference"), "A",
                           QObject::tr("All that stands around the picture, on and off"),
                           [&store] {
                               store.edit(QObject::tr("Frame of reference"), {}, [](Session& session) {
                                   session.reference.edit([](FrameOfReference& r) { r.on = !r.on; });
                               });
                           },
                           editable, {.checked = [&store] { return store.session().reference->on; }});
    for (const FramePartInfo& info : kFrameParts) {
        const auto [id, text, tip] = textsOf(info.part);
        services.actions().add(menu, id, text, {}, tip,
                               [&store, name = QString(text).remove('&'), shown = info.shown] {
                                   store.edit(name, {}, [&](Session& session) {
                                       session.reference.edit([&](FrameOfReference& r) {
                                           r.*shown = !(r.on && r.*shown);
                                           r.on = true;
                                       });
                                   });
                               },
                               editable,
                               {.checked = [&store, shown = info.shown] { return (*store.session().reference).*shown; },
                                .separatorBefore = info.part == FramePart::Cube});
    }
}

} // namespace pellucid::gui
