// One HTML file that shows a scene in a browser, without a network: its voxels, its look, and a ray caster.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/enum_names.h"
#include "base/job.h"
#include "base/setting.h"
#include "session/scene.h"

namespace pellucid {

enum class ShareBits { Auto, Eight, Sixteen };
template <>
inline constexpr auto kNamesOf<ShareBits> = enumNames("number of bits", "auto", "8", "16");
enum class ShareDensity { On, Off };
template <>
inline constexpr auto kNamesOf<ShareDensity> = enumNames("choice", "on", "off");

struct ShareSettings {
    int voxels = 16'777'216;                 ///< at most so many; a larger volume is made coarser
    std::optional<double> megabytes = {};    ///< likewise of the file, 10⁶ bytes; empty: as many as it takes
    ShareBits bits = ShareBits::Auto;        ///< of an intensity; Auto: 8 where they hold all values, else 16
    std::string title = {};                  ///< empty: proposedTitle()
    ShareDensity density = ShareDensity::On; ///< the slider of equal shares
    bool operator==(const ShareSettings&) const = default;
};
template <>
std::span<const Setting> settingsOf<ShareSettings>();

struct ShareTask {
    Scene scene;
    RenderSettings look; ///< how it is drawn; its size is not used
    ShareSettings settings = {};
    std::string path = {};
};

struct SharedPage {
    std::size_t bytes = 0;       ///< of the file
    std::size_t packedBytes = 0; ///< of the voxels in it, before they become text
    Int3 dims{0, 0, 0};
    int factor = 1; ///< by which it is coarser
    int bits = 8;
    double largestError = 0; ///< of an intensity, [0, 0.5]; 0: as exact as the samples
    bool hasDensity = false;
    std::vector<std::string> leftOut; ///< remarks on what the page does not show
};

/// Said before a page is written.
inline constexpr const char* kSharePrivacy =
    "the page holds the voxels themselves, so whoever gets it has the data; no names, dates or other texts of DICOM go "
    "into it";

/// The title of a page where nobody gives one: the name of the file without folder and suffix. What DICOM is read from
/// may be named after people: "Volume" there, and where it is not known.
std::string proposedTitle(const Scene& scene);

/// What a page would hold, about how large it would be, and how large all voxels of the volume would be.
struct ShareEstimate {
    Int3 dims{0, 0, 0};
    int factor = 1;
    int bits = 8;
    double bytes = 0;
};
/// About how many bytes of a page a voxel takes. Compresses a few layers.
double pageBytesPerVoxel(const Scene& scene, ShareBits bits);
/// `perVoxel`: pageBytesPerVoxel() of settings.bits. `settings.megabytes` is heeded.
ShareEstimate estimateShare(const Scene& scene, const ShareSettings& settings, double perVoxel);

/// What can be told before any work. Throws UsageError (a transparent background) and Error (a field, colours by voxel,
/// a mode that is not emission and absorption).
void checkShare(const ShareTask& task);
/// Measures, draws and writes it; the file is whole or absent. Throws as checkShare() does, FileError, Error where not
/// even a single voxel keeps the file within its megabytes, Cancelled.
SharedPage makeShare(const ShareTask& task, const JobControl& job = {});

} // namespace pellucid
