// The opacities of the first picture of a volume, chosen for its view so that outer features let the inner ones through
// (docs/method.md, "The automatic start").
#pragma once

#include <vector>

#include "optimize/ray_bundle.h"
#include "tf/proposal.h"

namespace pellucid {

/// Covers that an automatic start wants: a ray's alpha grows with the importance of what it meets, and is divided among
/// that by importance. Per feature the mean over the rays that meet it; 0 where none does. `everywhere`: there is no
/// background, so that what is unimportant is a haze before all else.
std::vector<double> wantedCovers(const RayBundle& rays, const std::vector<double>& importance, bool everywhere);

/// How much a feature should be seen, [0,1]: deep and rare ones more.
std::vector<double> importanceOf(const Proposal& proposal);

/// What the first picture is drawn with, and what that aims at.
struct FirstSight {
    TransferFunction tf;
    std::vector<double> shares; ///< per feature, of the alpha that is wanted, sum 1; empty where nothing is in sight
    FaintRest rest;             ///< what the object lies on
};

/// `tf`, which has the features of `proposal`, with peak opacities for this view: covers near the wanted ones, between
/// 6 and 94 % of the rays translucent, and at least 15 % of the visibility for the second feature where there is one.
/// The same answer for any number of threads; a fixed number of evaluations. What has no features, or none in sight,
/// comes back as it is. Throws Cancelled.
FirstSight withOpacitiesForView(const Volume& volume, const Proposal& proposal, const TransferFunction& tf,
                                const View& view, const JobControl& job = {});

} // namespace pellucid
