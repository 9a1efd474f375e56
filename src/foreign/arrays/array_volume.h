// One of the arrays in an HDF5 or NetCDF file, as a volume. Runs in pellucid-array-reader only.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "foreign/arrays/array_axes.h"
#include "foreign/arrays/array_file.h"
#include "foreign/arrays/packed_values.h"

namespace pellucid {

class ArrayVolume final : public ForeignVolume {
public:
    /// `wanted`: the name of an array, with its groups or, where no other has it, without; empty: the largest that can
    /// be read and is no coordinate of another. Throws FileError where there is none with three axes or more,
    /// UsageError where there is not the one that is wanted.
    ArrayVolume(std::unique_ptr<ArrayFile> file, const std::string& path, const std::string& wanted);

    FileContents contents() const override;
    std::vector<std::string> files() const override { return m_file->files(); }
    ReaderLayout layout(int step) const override;
    std::uint64_t largestImageBytes() const override;
    void read(int step, const ReaderBox& box, std::span<std::byte> voxels, const BeforeFile& before,
              const JobControl& job) const override;

private:
    void choose(const std::string& wanted);
    void take(const ArrayVariable& variable);
    std::uint64_t steps() const;
    /// Of one step, along each axis of the file: all of it, or a part.
    ArrayBox boxOf(int step) const;
    ArrayBox boxOf(int step, const ReaderBox& part) const;
    /// By which it is read, along each axis of the file: whole blocks, as they are stored.
    std::vector<std::int64_t> pieceSize(const ArrayBox& whole) const;
    std::uint64_t bytesIn(const std::vector<std::int64_t>& size) const;

    std::unique_ptr<ArrayFile> m_file;
    std::string m_path;
    std::vector<const ArrayVariable*> m_volumes; ///< all that can be shown
    const ArrayVariable* m_chosen = nullptr;
    ArrayAxes m_axes;
    PackedValues m_packed;
    std::vector<std::string> m_notices;
};

} // namespace pellucid
