#include "panels/plot_words.h"

#include <utility>

#include "widgets/terms.h"

namespace pellucid::gui {
namespace {

/// What plots of src/report are called by, and the same in plain words.
const std::pair<const char*, const char*> kTitles[] = {{"Visibility-weighted saliency", QT_TR_NOOP("Attention")},
                                                       {"Feature visibility", QT_TR_NOOP("Seen")},
                                                       {"2D feature saliency", QT_TR_NOOP("In the picture")}};
const std::pair<const char*, const char*> kLabels[] = {{"VWS", QT_TR_NOOP("attention")},
                                                       {"FV", QT_TR_NOOP("seen")},
                                                       {"2DFS", QT_TR_NOOP("in the picture")},
                                                       {"F", QT_TR_NOOP("off target")}};

} // namespace

Plot inWords(Plot plot) {
    if (terms().areScientific()) return plot;
    for (const auto& [from, to] : kTitles)
        if (plot.title.starts_with(from)) // the name of a run may follow
            plot.title.replace(0, std::string(from).size(), QObject::tr(to).toStdString());
    for (const auto& [from, to] : kLabels)
        if (plot.y.label == from) {
            plot.y.label = QObject::tr(to).toStdString();
            break;
        }
    return plot;
}

} // namespace pellucid::gui
