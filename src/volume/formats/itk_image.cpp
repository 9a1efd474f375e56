#include "volume/formats/itk_image.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <iostream>
#include <limits>
#include <mutex>
#include <type_traits>

#include <locale.h>

#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>

#include "volume/formats/file_check.h"
#include "volume/memory_use.h"

namespace pellucid {

namespace {

/// While it lives, the format libraries are silent and read numbers with a point.
/// Silent: MetaIO writes its complaints to std::cerr and std::cout; users get our one line, stdout carries only
/// answers. One reader at a time, since the streams belong to the process. The point: the NRRD and MetaIO parsers
/// follow the C locale of the process, which a desktop program takes from its user.
class LibraryCall {
public:
    LibraryCall()
        : m_lock(s_mutex), m_out(std::cout.rdbuf(nullptr)), m_error(std::cerr.rdbuf(nullptr)),
          m_plain(newlocale(LC_NUMERIC_MASK, "C", duplocale(LC_GLOBAL_LOCALE))), m_before(uselocale(m_plain)) {
        itk::Object::SetGlobalWarningDisplay(false);
    }
    ~LibraryCall() {
        uselocale(m_before);
        freelocale(m_plain);
        std::cout.rdbuf(m_out); // also clears the error state that writing to nothing left behind
        std::cerr.rdbuf(m_error);
    }
    LibraryCall(const LibraryCall&) = delete;
    LibraryCall& operator=(const LibraryCall&) = delete;

private:
    static std::mutex s_mutex;
    std::lock_guard<std::mutex> m_lock;
    std::streambuf* m_out;
    std::streambuf* m_error;
    locale_t m_plain, m_before; // of this thread only
};
std::mutex LibraryCall::s_mutex;

/// The last line of the NRRD library's own account, which is the cause; empty for the others, whose texts name source
/// files and say no more than that reading failed.
std::string causeIn(const std::string& description) {
    const std::size_t last = description.rfind("[nrrd] ");
    if (last == std::string::npos) return {};
    const std::size_t length = std::min(description.find('\n', last), last + 160) - last - 7;
    const std::string line = description.substr(last + 7, length);
    const std::size_t function = line.find(": "); // "nrrdLoad: cause"
    return trimmed(function == std::string::npos ? line : line.substr(function + 2));
}

/// Runs `call` with ITK's and the format libraries' exceptions turned into one FileError.
template <class Call>
void translated(const std::string& path, const Call& call) {
    const char* kToDo = "the file may be damaged, write or copy it again";
    try {
        const LibraryCall scope;
        call();
    } catch (const Error&) {
        throw;
    } catch (const itk::ExceptionObject& e) {
        const std::string cause = causeIn(e.GetDescription());
        throw FileError("the file cannot be read" + (cause.empty() ? "" : " (" + cause + ")"), path, kToDo);
    } catch (const std::bad_alloc&) {
        throw FileError("there is not enough memory to read it", path, "close other programs");
    } catch (const std::exception&) {
        throw FileError("the file cannot be read", path, kToDo);
    }
}

using Component = itk::IOComponentEnum;

/// Calls use(T{}) with the type of the samples in memory.
template <class Use>
void withComponentType(Component type, const std::string& path, const Use& use) {
    static_assert(sizeof(short) == 2 && sizeof(int) == 4 && sizeof(long long) == 8);
    using Long = std::conditional_t<sizeof(long) == 8, std::int64_t, std::int32_t>;
    switch (type) {
    case Component::UCHAR:
        return use(std::uint8_t{});
    case Component::CHAR:
        return use(std::int8_t{});
    case Component::USHORT:
        return use(std::uint16_t{});
    case Component::SHORT:
        return use(std::int16_t{});
    case Component::UINT:
        return use(std::uint32_t{});
    case Component::INT:
        return use(std::int32_t{});
    case Component::ULONG:
        return use(std::make_unsigned_t<Long>{});
    case Component::LONG:
        return use(Long{});
    case Component::ULONGLONG:
        return use(std::uint64_t{});
    case Component::LONGLONG:
        return use(std::int64_t{});
    case Component::FLOAT:
        return use(float{});
    case Component::DOUBLE:
        return use(double{});
    default:
        throw FileError("the type of its samples is not supported", path, "convert it to 8 to 32 bit or float");
    }
}

/// 64-bit integers have no sample type of their own.
template <class T>
using StoredType = std::conditional_t<std::is_integral_v<T> && sizeof(T) == 8, double, T>;

struct Layout {
    std::uint64_t components = 1; ///< per voxel, beside each other
    std::uint64_t voxels = 0;     ///< of the first time step
    std::uint64_t values = 0;     ///< everything
    int component = 0;            ///< the one to take
};

template <class T>
Samples readSamples(itk::ImageIOBase& io, const std::string& path, const Layout& layout) {
    std::vector<T> all(static_cast<std::size_t>(layout.values));
    translated(path, [&] { io.Read(all.data()); });
    if constexpr (std::is_same_v<T, StoredType<T>>) {
        if (layout.values == layout.voxels) return all;
    }
    std::vector<StoredType<T>> first(static_cast<std::size_t>(layout.voxels));
    for (std::size_t i = 0; i < first.size(); ++i)
        first[i] = static_cast<StoredType<T>>(
            all[i * static_cast<std::size_t>(layout.components) + static_cast<std::size_t>(layout.component)]);
    return first;
}

/// The object is made here and not by ITK's factories: nothing is registered, nothing guesses the format.
itk::ImageIOBase::Pointer makeImageIO(ItkFormat format) {
    switch (format) {
    case ItkFormat::Nrrd:
        return itk::NrrdImageIO::New().GetPointer();
    case ItkFormat::MetaImage:
        return itk::MetaImageIO::New().GetPointer();
    case ItkFormat::Nifti:
        return itk::NiftiImageIO::New().GetPointer();
    }
    PELLUCID_CHECK(false);
}

bool axesAreIdentity(const itk::ImageIOBase& io, unsigned dimensions) {
    for (unsigned axis = 0; axis < dimensions; ++axis) {
        const std::vector<double> direction = io.GetDirection(axis);
        for (unsigned c = 0; c < dimensions && c < direction.size(); ++c)
            if (std::abs(direction[c] - (c == axis ? 1.0 : 0.0)) > 1e-6) return false;
    }
    return true;
}

} // namespace

Volume readWithItk(ItkFormat format, const VolumeSource& source, const HeaderClaim& claim, const JobControl& job) {
    const itk::ImageIOBase::Pointer pointer = makeImageIO(format);
    itk::ImageIOBase& io = *pointer;
    const std::string& path = source.path;
    job.throwIfStopped();
    translated(path, [&] {
        io.SetFileName(path);
        io.ReadImageInformation();
    });

    const unsigned axes = io.GetNumberOfDimensions();
    const unsigned spatial = std::min(axes, 3u);
    Geometry geometry;
    geometry.dims = {1, 1, 1};
    Layout layout;
    layout.components = io.GetNumberOfComponents();
    layout.component = source.component;
    std::vector<std::int64_t> sizes{static_cast<std::int64_t>(layout.components)};
    for (unsigned a = 0; a < axes; ++a) sizes.push_back(static_cast<std::int64_t>(io.GetDimensions(a)));
    layout.values = valueCount(path, sizes, sizeof(double));
    if (axes == 0 || layout.values != claim.values)
        throw FileError("the header contradicts itself", path, "correct its dimensions");
    for (unsigned a = 0; a < spatial; ++a) {
        geometry.dims[static_cast<int>(a)] = static_cast<int>(io.GetDimensions(a));
        geometry.spacing[static_cast<int>(a)] = io.GetSpacing(a);
        geometry.origin[static_cast<int>(a)] = io.GetOrigin(a);
        if (!(io.GetSpacing(a) > 0) || !std::isfinite(io.GetSpacing(a)) || !std::isfinite(io.GetOrigin(a)))
            throw FileError("spacing must be positive and finite, origin finite", path, "correct the header");
    }
    layout.voxels = voxelCount(geometry.dims);
    if (source.component < 0 || static_cast<std::uint64_t>(source.component) >= layout.components)
        throw UsageError("there is no component " + std::to_string(source.component), path,
                         layout.components == 1 ? "the file has one component, number 0"
                                                : "give 0 to " + std::to_string(layout.components - 1));

    std::vector<std::string> notices = claim.notices;
    if (layout.components > 1)
        notices.push_back("component " + std::to_string(source.component) + " of " + std::to_string(layout.components) +
                          " is shown");
    const std::uint64_t steps = layout.values / layout.components / layout.voxels;
    if (steps > 1) notices.push_back("the first of " + std::to_string(steps) + " time steps is shown");
    if (!axesAreIdentity(io, spatial))
        notices.emplace_back(
            "the directions of the axes in the file are not applied, the volume is shown along its grid");

    itk::ImageIORegion region(axes);
    for (unsigned a = 0; a < axes; ++a) region.SetSize(a, io.GetDimensions(a));
    io.SetIORegion(region);

    job.report(0.1);
    job.throwIfStopped();
    Samples samples;
    withComponentType(io.GetComponentType(), path, [&](auto zero) {
        using T = decltype(zero);
        using Stored = StoredType<T>;
        if constexpr (!std::is_same_v<T, Stored>) notices.emplace_back("64-bit integers are kept as 64-bit floats");
        // The format libraries hold the file's own bytes beside the result while they decode or convert.
        std::uint64_t needed = layout.values * sizeof(T) + claim.values * claim.bytesPerValue;
        if (layout.values != layout.voxels || !std::is_same_v<T, Stored>) needed += layout.voxels * sizeof(Stored);
        requireMemory(source.then, path, geometry.dims, needed, layout.voxels * sizeof(Stored));
        samples = readSamples<T>(io, path, layout);
    });
    job.throwIfStopped();
    job.report(0.9);
    Volume volume(geometry, std::move(samples), source.missing);
    volume.notices = std::move(notices);
    return volume;
}

} // namespace pellucid
