// 2D saliency: what of a picture catches the eye, and how much of that each feature has (docs/method.md, "2D feature
// saliency"; thesis appendix A).
#pragma once

#include <vector>

#include "base/image.h"
#include "base/job.h"
#include "base/plane.h"

namespace pellucid {

/// A picture and, in the same size, the pictures of its features.
struct FeaturePictures {
    Image whole;              ///< as it is seen: alpha 1
    std::vector<Image> alone; ///< each feature with the others hidden; colours as they are seen, over the background of
                              ///< `whole`; alpha that of the feature, 0 where it is not drawn
};

/// Of one picture. Planes have its size.
struct FeatureSaliency {
    Plane map;                    ///< S, [0,1]
    std::vector<double> shares;   ///< FS: of the saliency of all features, that of each; sum 1 or all 0
    std::vector<Plane> shared;    ///< S_i: what each feature has of S where it is drawn
    Plane rest;                   ///< S − ΣS_i
    std::vector<Plane> influence; ///< S_i blurred, in no unit: by it the rest is dealt out
    std::vector<Plane> spread;    ///< what each feature has of the rest
};

/// T_i: what a feature has of S, of the rest too.
Plane totalOf(const FeatureSaliency& saliency, std::size_t feature);

/// S of what is seen of a picture over black where it is transparent: after Itti, Koch and Niebur, [0,1]. A picture of
/// one colour has 0 everywhere. The same bits for any thread count.
Plane saliencyMap(const Image& picture, const JobControl& job = {});
/// The same by the book, slowly.
Plane saliencyMapReference(const Image& picture);

/// Throws Error where the pictures differ in size.
FeatureSaliency featureSaliency(const FeaturePictures& pictures, const JobControl& job = {});
/// The same by the book, slowly.
FeatureSaliency featureSaliencyReference(const FeaturePictures& pictures);

} // namespace pellucid
