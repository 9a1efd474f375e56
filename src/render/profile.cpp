#include "render/profile.h"

#include <array>

#include "base/error.h"

namespace pellucid {

namespace {
constexpr std::array kAlong{Along::Top, Along::Bottom, Along::Front, Along::Back, Along::Left, Along::Right};
}

const char* name(Profile profile) { return profile == Profile::Default ? "default" : "published"; }

Profile profileFromName(const std::string& text) {
    for (const Profile p : {Profile::Default, Profile::Published})
        if (text == name(p)) return p;
    throw UsageError("there is no profile '" + text + "'", "profile", "choose default or published");
}

const char* name(Along along) {
    constexpr std::array kNames{"top", "bottom", "front", "back", "left", "right"};
    return kNames[static_cast<std::size_t>(along)];
}

Along alongFromName(const std::string& text) {
    for (const Along a : kAlong)
        if (text == name(a)) return a;
    throw UsageError("there is no side '" + text + "'", "along", "choose top, bottom, front, back, left or right");
}

} // namespace pellucid
