// Targets that are held while something else changes: the view, a colour, how figures are computed.
#pragma once

#include <map>
#include <set>
#include <vector>

#include "session/workspace.h"

namespace pellucid {

/// What is to be held, and from where: the opacities of `input.tf` are those of the state before.
struct HeldTargets {
    MeasureInput input;
    std::vector<double> targets;       ///< shares, as Scene::targets()
    std::vector<OpacityLimits> limits; ///< see limitsOf()
    OptimizeOptions options;           ///< the session's; coverage is of no concern here
    bool operator==(const HeldTargets&) const = default;
};

struct LiveUpdate {
    std::vector<double> opacity; ///< per feature
    std::vector<double> vws;     ///< W there
    double objective = 0;        ///< F there
    bool approximate = false;    ///< W and F are estimates along rays
};

/// One move toward the targets, on large volumes by rays alone: what keeps up with the hand; W of the volume itself may
/// differ by a hundredth. Never farther from the targets than it began, by the figures that the update tells. Throws as
/// Workspace::optimize() does, Cancelled too.
LiveUpdate followTargets(Workspace& workspace, const HeldTargets& held, const JobControl& job = {});
/// The same on the volume itself until the targets are met or nothing helps: what is done when all rests.
LiveUpdate settleTargets(Workspace& workspace, const HeldTargets& held, const JobControl& job = {});

/// Whether both have features of the same identities, in the same order.
bool sameFeatures(const TransferFunction& a, const TransferFunction& b);
/// Of two with the sameFeatures(): those whose opacity has changed, to another one than an update `wanted`. None where
/// all have: then somebody wants another density, and the shares come back.
std::set<FeatureId> setByHand(const TransferFunction& before, const TransferFunction& after,
                              const std::map<FeatureId, double>& wanted);

} // namespace pellucid
