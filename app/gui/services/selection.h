// What is pointed at, in whatever panel: so that all of them can show it.
#pragma once

#include <optional>

#include <QObject>

#include "tf/feature.h"

namespace pellucid::gui {

/// No part of the session: nothing depends on it but what is highlighted. Found by identity, a selected feature may
/// have gone meanwhile; who draws it looks it up.
class Selection : public QObject {
    Q_OBJECT
public:
    using QObject::QObject;

    FeatureId feature() const { return m_feature; } ///< 0: none
    void setFeature(FeatureId feature) {
        if (feature == m_feature) return;
        m_feature = feature;
        Q_EMIT featureChanged();
    }

    /// The intensity under the mouse, where some view knows one, [0,1].
    std::optional<double> hoveredIntensity() const { return m_hovered; }
    void setHoveredIntensity(std::optional<double> intensity) {
        if (intensity == m_hovered) return;
        m_hovered = intensity;
        Q_EMIT hoveredChanged();
    }

Q_SIGNALS:
    void featureChanged();
    void hoveredChanged();

private:
    FeatureId m_feature = 0;
    std::optional<double> m_hovered;
};

} // namespace pellucid::gui
