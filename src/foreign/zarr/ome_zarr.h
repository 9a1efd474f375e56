// Volumes in folders of Zarr: OME-Zarr (NGFF 0.1 to 0.5) with its levels of detail, or arrays by themselves. Runs in
// pellucid-array-reader only.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "foreign/arrays/packed_values.h"
#include "foreign/foreign_volume.h"
#include "foreign/zarr/zarr_array.h"

namespace pellucid {

class OmeZarr final : public ForeignVolume {
public:
    /// `wanted`: an image or an array by its path in the folder; empty: the largest image, or the largest array where
    /// there is none. Throws FileError, UsageError for an image that is not there.
    OmeZarr(const std::string& path, const std::string& wanted, const BeforeFile& before);

    FileContents contents() const override;
    std::vector<std::string> files() const override;
    ReaderLayout layout(int step) const override;
    std::uint64_t largestImageBytes() const override;
    void read(int step, const ReaderBox& box, std::span<std::byte> voxels, const BeforeFile& before,
              const JobControl& job) const override;

private:
    /// What can be opened: arrays of one image, from fine to coarse. All but the first are coarser copies of that.
    struct Image {
        std::string name; ///< path in the folder; empty: the folder itself
        std::vector<ZarrArray> levels;
        std::string axes; ///< a letter of "tczyx" for each, or "1": it has one entry and is no place
        Vec3 spacing{1, 1, 1};
        LengthUnit lengthUnit = LengthUnit::Unknown; ///< of spacing and origins
        std::vector<std::optional<Vec3>> origins;    ///< of each level; empty: it does not say
        Mat3 directions{1};
        std::optional<PackedValues> packed;  ///< of an array that is no image
        double firstStep = 0, stepWidth = 0; ///< in timeUnit; a width of 0: not known
        std::vector<double> times;           ///< of the steps, where coordinates tell each
        std::string timeUnit;
        std::vector<std::string> notices;
        std::int64_t size(char axis, std::size_t level = 0) const;
        Int3 dims(std::size_t level = 0) const;
        Int3 factors(std::size_t level) const;   ///< voxels of level 0 to one of `level`
        bool isCoarser(std::size_t level) const; ///< whether it is level 0 in fewer voxels, and nothing else
    };
    void find(const std::string& folder, const std::string& name, int depth, const BeforeFile& before);
    void addImage(const std::string& folder, const std::string& name, const JsonValue& multiscale,
                  const BeforeFile& before);
    void addArray(const std::string& folder, const std::string& name, const ZarrNode& node, const BeforeFile& before);

    std::string m_path;
    std::vector<Image> m_images;
    std::vector<FileError> m_faults;
    std::size_t m_shown = 0;
};

} // namespace pellucid
