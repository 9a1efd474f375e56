// What an object lies on, remembered while it is drawn like the rest.
#pragma once

#include <map>
#include <memory>

#include "session/scene.h"

namespace pellucid::gui {

class KnownHolder {
public:
    /// Of the scene's series, as faint as it was at first; empty where there has been none.
    const FaintRest& of(const Scene& scene) {
        std::erase_if(m_rests, [](const auto& entry) { return entry.first.expired(); });
        FaintRest& known = m_rests[scene.series];
        const FaintRest& now = scene.session.clipping->rest;
        // Numbers on the way to the one that somebody means are none to come back to.
        if (!now.isNone() && (now.within != known.within || known.density == 0)) known = now;
        return known;
    }

private:
    using Series = std::weak_ptr<const TimeSeries>;
    std::map<Series, FaintRest, std::owner_less<Series>> m_rests;
};

} // namespace pellucid::gui
