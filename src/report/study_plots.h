// Opinions of a study as plots (thesis figures 4.14 and 4.15).
#pragma once

#include <vector>

#include "report/plot.h"
#include "study/analysis.h"

namespace pellucid {

/// Mean opinions over what a measure says of the same pictures, volumes in colours of their own; second showings are
/// hollow (fig 4.14).
Plot opinionPlot(const StudyAnalysis& analysis, StudyMeasure measure);

/// Mean opinions with their intervals over VWS, of one feature (fig 4.15).
Plot featureOpinionPlot(const StudyAnalysis& analysis, const FeatureOpinions& feature);

/// Mean difference between both scores of a repeated picture, of each participant who has some, the most consistent
/// first; hollow where the answers do not count. Dashed: what is tolerated.
Plot consistencyPlot(const StudyAnalysis& analysis);

} // namespace pellucid
