// What an object lies on, remembered while it is drawn like the rest.
#pragma once

#include <map>
#include <memory>

#include "session/scene.h"

namespace pellucid::gui {

class KnownHolder {
public:
    /// Of the scene's series, as it was when it was last faint; empty where there has been none.
    const FaintRest& of(const Scene& scene) {
        std::erase_if(m_rests, [](const auto& entry) { return entry.first.expired(); });
        FaintRest& known = m_rests[scene.series];
        const FaintRest& now = scene.session.clipping->rest;
        const bool isFaint = now.density > 0 && now.density <= kMostFaint;
        if (!now.isNone() && (now.within != known.within || isFaint)) known = now;
        return known;
    }

private:
    /// More is on the way to drawing it like the rest.
    static constexpr double kMostFaint = 0.5;
    using Series = std::weak_ptr<const TimeSeries>;
    std::map<Series, FaintRest, std::owner_less<Series>> m_rests;
};

} // namespace pellucid::gui
