#include "optimize/coverage.h"

namespace pellucid {

std::vector<Coverage> coverageOf(const RayBundle& rays, const std::vector<TransferFunction>& tfs) {
    std::vector<Coverage> all;
    all.reserve(tfs.size());
    for (RayBundle::Appearance& a : rays.appearances(tfs)) all.push_back({a.alpha, std::move(a.covers)});
    return all;
}

Coverage coverageOf(const RayBundle& rays, const TransferFunction& tf) {
    return coverageOf(rays, std::vector<TransferFunction>{tf})[0];
}

} // namespace pellucid
