#include "widgets/mouse_scheme.h"

#include <QCoreApplication>
#include <QStringList>

namespace pellucid::gui {
namespace {

constexpr Qt::KeyboardModifiers kNone = Qt::NoModifier, kShift = Qt::ShiftModifier, kCtrl = Qt::ControlModifier;
constexpr auto kLeft = Qt::LeftButton, kMiddle = Qt::MiddleButton, kRight = Qt::RightButton;
constexpr Qt::KeyboardModifiers kCounted = kShift | kCtrl | Qt::AltModifier | Qt::MetaModifier;

constexpr MouseDrag kPellucid[] = {{kLeft, kNone, Motion::Rotate},
                                   {kMiddle, kNone, Motion::Pan},
                                   {kRight, kNone, Motion::Zoom},
                                   {kLeft, kShift, Motion::Pan},
                                   {kLeft, kCtrl, Motion::Light}};
// Neither of the others turns a light with the mouse: it has the keys that they leave.
constexpr MouseDrag kParaView[] = {{kLeft, kNone, Motion::Rotate},    {kMiddle, kNone, Motion::Pan},
                                   {kRight, kNone, Motion::Zoom},     {kLeft, kShift, Motion::Roll},
                                   {kMiddle, kShift, Motion::Rotate}, {kRight, kShift, Motion::Pan},
                                   {kLeft, kCtrl, Motion::Zoom},      {kMiddle, kCtrl, Motion::Rotate},
                                   {kRight, kCtrl, Motion::Zoom},     {kLeft, kCtrl | Qt::AltModifier, Motion::Light}};
constexpr MouseDrag kSlicer[] = {{kLeft, kNone, Motion::Rotate},
                                 {kMiddle, kNone, Motion::Pan},
                                 {kRight, kNone, Motion::Zoom},
                                 {kLeft, kShift, Motion::Pan},
                                 {kLeft, kCtrl, Motion::Roll},
                                 {kLeft, kCtrl | kShift, Motion::Zoom},
                                 {kLeft, kCtrl | Qt::AltModifier, Motion::Light}};

MouseScheme s_scheme = MouseScheme::Pellucid;

QString tr(const char* text) { return QCoreApplication::translate("MouseScheme", text); }

QString nameOf(const MouseDrag& drag) {
    QStringList parts;
    if (drag.keys.testFlag(Qt::ControlModifier)) parts << tr("Ctrl");
    if (drag.keys.testFlag(Qt::ShiftModifier)) parts << tr("Shift");
    if (drag.keys.testFlag(Qt::AltModifier)) parts << tr("Alt");
    parts << (drag.button == kLeft ? tr("left drag") : drag.button == kMiddle ? tr("middle drag") : tr("right drag"));
    return parts.join(" + ");
}

struct MotionWords {
    Motion motion;
    const char *before, *after, *what; ///< what else does the same, before and after the drags
};
constexpr MotionWords kWords[] = {
    {Motion::Rotate, "", QT_TRANSLATE_NOOP("MouseScheme", "arrow keys"), QT_TRANSLATE_NOOP("MouseScheme", "rotate")},
    {Motion::Pan, "", "", QT_TRANSLATE_NOOP("MouseScheme", "pan")},
    {Motion::Zoom, QT_TRANSLATE_NOOP("MouseScheme", "wheel"), QT_TRANSLATE_NOOP("MouseScheme", "+ and −"),
     QT_TRANSLATE_NOOP("MouseScheme", "zoom")},
    {Motion::Roll, "", "", QT_TRANSLATE_NOOP("MouseScheme", "roll about the line of sight")},
    {Motion::Light, "", "", QT_TRANSLATE_NOOP("MouseScheme", "turn the light")},
};

} // namespace

std::span<const MouseDrag> dragsOf(MouseScheme scheme) {
    switch (scheme) {
    case MouseScheme::ParaView:
        return kParaView;
    case MouseScheme::Slicer:
        return kSlicer;
    default:
        return kPellucid;
    }
}

std::optional<Motion> motionOf(MouseScheme scheme, Qt::MouseButton button, Qt::KeyboardModifiers keys) {
    std::optional<Motion> without;
    for (const MouseDrag& drag : dragsOf(scheme)) {
        if (drag.button != button) continue;
        if (drag.keys == (keys & kCounted)) return drag.motion;
        if (drag.keys == kNone) without = drag.motion;
    }
    return without;
}

bool zoomsInDownward(MouseScheme scheme) { return scheme != MouseScheme::Pellucid; }

std::vector<MotionText> motionTexts(MouseScheme scheme) {
    std::vector<MotionText> texts;
    for (const MotionWords& words : kWords) {
        QStringList drags;
        for (const MouseDrag& drag : dragsOf(scheme))
            if (drag.motion == words.motion) drags << nameOf(drag);
        if (drags.isEmpty()) continue;
        if (words.motion == Motion::Zoom)
            drags.back() += zoomsInDownward(scheme) ? tr(" (down: closer)") : tr(" (up: closer)");
        if (*words.before != '\0') drags.prepend(tr(words.before));
        if (*words.after != '\0') drags << tr(words.after);
        QString how = drags.join(", ");
        how[0] = how[0].toUpper();
        texts.push_back({how, tr(words.what)});
    }
    return texts;
}

void setMouseScheme(MouseScheme scheme) { s_scheme = scheme; }
MouseScheme mouseScheme() { return s_scheme; }

} // namespace pellucid::gui
