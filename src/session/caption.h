// A picture in words: from where it is seen, and how much of what there is, as it has been measured.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "optimize/answer/occlusion.h"
#include "optimize/measure.h"
#include "render/render_settings.h"
#include "session/scene.h"

namespace pellucid {

/// What is said of a feature.
struct CaptionFeature {
    std::string name;
    double vws = 0, visibility = 0;                                 ///< shares, [0,1]
    enum class State { Drawn, Hidden, Empty } state = State::Drawn; ///< Empty: this frame has no voxel of it
};

/// What is said of a picture.
struct CaptionFacts {
    std::string title; ///< of the volume
    std::string frame; ///< "t = 12.3 s"; empty: there is one
    std::string from;  ///< as directionWords()
    bool lit = false;  ///< shaded
    bool cut = false;  ///< some of it is cut away
    RenderMode mode = RenderMode::Composite;
    std::string alone; ///< the only feature that is drawn; its figures are those among all. Empty: all are drawn
    std::vector<CaptionFeature> features; ///< those that are shown, in the order of the transfer function
    std::vector<std::string> hides;       ///< "skin hides 83 % of bone"
    std::optional<double> coverage; ///< how opaque the picture is where there is something, [0,1]; empty: not known
};

/// Where an observer is, in words of the world: "from the front", "from the patient's left and above". `towardEye`: a
/// direction in the world, of any length but 0. A side counts where it lies within 67.5 degrees of the direction, the
/// nearest first.
std::string directionWords(const Vec3& towardEye, WorldAxes axes);

/// `measures` of this scene, of its features or of none; `occlusion` may be empty.
CaptionFacts captionFacts(const Scene& scene, const Measures& measures, const OcclusionMatrix& occlusion = {});

/// A few sentences: the view, the shares of up to four features and of the others together, what hides what, what is
/// left out. Of a feature that is drawn alone: its shares where all are drawn. Modes other than compositing show no
/// shares: they get the first sentence alone.
std::string caption(const CaptionFacts& facts);

/// One sentence for those who do not see the picture, shorter: the view, and the two features with most saliency.
std::string altText(const CaptionFacts& facts);

} // namespace pellucid
