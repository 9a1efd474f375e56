// What several panels do: follow a part of the session, offer its features, export curves.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "services/services.h"
#include "store/edits.h"

class QAction;
class QComboBox;
class QToolButton;

namespace pellucid {
struct Plot;
}

namespace pellucid::gui {

/// Calls `follow` now, where the volume or one of these parts becomes another one, and where editing begins or ends.
template <class... T>
void followParts(Services& services, QObject* context, const std::function<void()>& follow,
                 Part<T> Session::*... parts) {
    QObject::connect(&services.store(), &SessionStore::changed, context, [=](const Scene& before, const Scene& after) {
        const bool same = ((before.session.*parts).isSame(after.session.*parts) && ...);
        if (before.volume != after.volume || !same) follow();
    });
    QObject::connect(&services, &Services::readOnlyChanged, context, follow);
    follow();
}

/// Does what the action does, and can be pressed when it can; its tool tip is the action's.
QToolButton* actionButton(QAction& does, const char* name, const QString& text, QWidget* parent);

/// A row for all features, which says `all`, and one per feature; `present` is the index of the feature that is chosen,
/// −1: all.
void fillFeatures(QComboBox& box, const Scene& scene, const QString& all, int present);
/// 0: all.
FeatureId chosenFeature(const QComboBox& box);

/// A row for each colour map that goes over values, whose data is its name.
void addColorMaps(QComboBox& box);

/// Where curves are to go, or empty. `suffix`, "csv", "png" or "svg": the only one offered; empty: any of them.
QString askCurveFile(Services& services, const QString& title, const QString& name, const QString& suffix = {});
/// Writes the table or the plots, by the suffix of `path`. Errors are shown.
void exportCurves(Services& services, const QString& path, const std::function<std::string()>& table,
                  const std::function<std::vector<Plot>()>& plots);

} // namespace pellucid::gui
