// What an object lies on, remembered while it is drawn like the rest.
#pragma once

#include "session/scene.h"

namespace pellucid::gui {

class KnownHolder {
public:
    /// As it was last of the scene's series, faint where it has ever been; empty where there has been none.
    const FaintRest& of(const Scene& scene) {
        if (scene.series != m_series) {
            m_series = scene.series;
            m_rest = {};
        }
        const FaintRest& now = scene.session.clipping->rest;
        if (!now.isNone() && (now.density > 0 || now.within != m_rest.within)) m_rest = now;
        return m_rest;
    }

private:
    std::shared_ptr<const TimeSeries> m_series;
    FaintRest m_rest;
};

} // namespace pellucid::gui
