// Writes TIFF: a page for each slice of each frame, as they are; OME-XML says how far slices are from each other.
// Values first, pages behind them, so that nothing has to be written twice (TIFF 6.0, sections 2 and 8; BigTIFF where 4
// GB are not enough).
#include <bit>
#include <cstring>

#include "base/round_numbers.h"
#include "volume/formats/writer.h"
#include "volume/orientation.h"

namespace pellucid {

namespace {

constexpr std::uint64_t kMostSmall = 4'000'000'000; ///< bytes of values that offsets of 32 bits can reach behind

/// How OME-XML writes a unit of time; empty: it has none of this name.
std::string timeUnit(const std::string& unit) { return unit == "s" || unit == "ms" || unit == "µs" ? unit : ""; }

std::string descriptionOf(const FramesToWrite& frames) {
    constexpr const char* kTypes[] = {"uint8", "int8", "uint16", "int16", "uint32", "int32", "float", "double"};
    const Geometry& g = frames.geometry;
    const auto attribute = [](const std::string& name, const std::string& value) {
        return " " + name + "=\"" + value + "\"";
    };
    std::string sizes;
    for (int a = 0; a < 3; ++a) {
        const std::string axis(1, "XYZ"[a]);
        sizes += attribute("Size" + axis, std::to_string(g.dims[a])) +
                 attribute("PhysicalSize" + axis, exactText(g.spacing[a]));
        const LengthUnit unit = unitOf(g); // without a word it would be micrometres
        sizes +=
            attribute("PhysicalSize" + axis + "Unit", unit == LengthUnit::Unknown ? "reference frame" : sign(unit));
    }
    if (frames.times && !timeUnit(frames.times->unit).empty())
        sizes += attribute("TimeIncrement", exactText(frames.times->width)) +
                 attribute("TimeIncrementUnit", timeUnit(frames.times->unit));
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?><OME xmlns=\"http://www.openmicroscopy.org/Schemas/OME/2016-06\">"
           "<Image ID=\"Image:0\"><Pixels ID=\"Pixels:0\" DimensionOrder=\"XYZCT\"" +
           attribute("Type", kTypes[static_cast<std::size_t>(frames.type)]) + sizes +
           attribute("SizeT", std::to_string(frames.count)) +
           " SizeC=\"1\"><Channel ID=\"Channel:0:0\" SamplesPerPixel=\"1\"/><TiffData IFD=\"0\" "
           "PlaneCount=\"" +
           std::to_string(static_cast<std::int64_t>(g.dims.z) * frames.count) + "\"/></Pixels></Image></OME>";
}

/// Numbers as a TIFF file of one kind has them.
class Directory {
public:
    explicit Directory(bool isLarge) : m_isLarge(isLarge) {}
    enum class Type : std::uint16_t { Text = 2, Short = 3, Long = 4, Long8 = 16 };

    /// Entries have to come in the order of their tags. `value`: a number, or where a longer text stands.
    void add(std::uint16_t tag, Type type, std::uint64_t count, std::uint64_t value) {
        put(tag);
        put(static_cast<std::uint16_t>(type));
        putSized(count);
        // A short number stands first in its field.
        if (type == Type::Short) {
            put(static_cast<std::uint16_t>(value));
            m_bytes.resize(m_bytes.size() + (m_isLarge ? 6 : 2));
        } else if (type == Type::Long && m_isLarge) {
            put(static_cast<std::uint32_t>(value));
            m_bytes.resize(m_bytes.size() + 4);
        } else {
            putSized(value);
        }
        ++m_entries;
    }
    /// With its number of entries before it, and where the next one is behind it.
    std::string bytes(std::uint64_t next) {
        Directory whole(m_isLarge);
        if (m_isLarge)
            whole.put(m_entries);
        else
            whole.put(static_cast<std::uint16_t>(m_entries));
        whole.m_bytes += m_bytes;
        whole.putSized(next);
        return whole.m_bytes;
    }
    std::uint64_t size() const { return m_bytes.size() + (m_isLarge ? 16 : 6); }

private:
    template <class T>
    void put(T value) {
        char bytes[sizeof value];
        std::memcpy(bytes, &value, sizeof value);
        m_bytes.append(bytes, sizeof value);
    }
    void putSized(std::uint64_t value) {
        if (m_isLarge)
            put(value);
        else
            put(static_cast<std::uint32_t>(value));
    }

    bool m_isLarge;
    std::uint64_t m_entries = 0;
    std::string m_bytes;
};

/// Of the slice whose values stand at `offset`. `text`: where the description stands; 0: it has none.
Directory pageOf(const FramesToWrite& frames, bool isLarge, std::uint64_t offset, std::uint64_t text,
                 std::size_t letters) {
    using Type = Directory::Type;
    const Int3& dims = frames.geometry.dims;
    const auto nx = static_cast<std::uint64_t>(dims.x), ny = static_cast<std::uint64_t>(dims.y);
    const SampleType type = frames.type;
    const std::uint64_t bytes = bytesPerSample(type);
    const bool isFloat = type == SampleType::F32 || type == SampleType::F64;
    const bool isSigned = type == SampleType::I8 || type == SampleType::I16 || type == SampleType::I32;
    const Type place = isLarge ? Type::Long8 : Type::Long;
    Directory page(isLarge);
    page.add(256, Type::Long, 1, nx);
    page.add(257, Type::Long, 1, ny);
    page.add(258, Type::Short, 1, 8 * bytes);
    page.add(259, Type::Short, 1, 1); // not compressed
    page.add(262, Type::Short, 1, 1); // black is zero
    if (text > 0) page.add(270, Type::Text, letters, text);
    page.add(273, place, 1, offset);
    page.add(277, Type::Short, 1, 1);
    page.add(278, Type::Long, 1, ny); // rows of a strip
    page.add(279, place, 1, nx * ny * bytes);
    page.add(339, Type::Short, 1, isFloat ? 3 : isSigned ? 2 : 1);
    return page;
}

void write(const FramesToWrite& frames, const std::string& path, const JobControl& job) {
    const Int3& dims = frames.geometry.dims;
    const std::uint64_t slice = layerSize(dims) * bytesPerSample(frames.type);
    const std::uint64_t slices = static_cast<std::uint64_t>(dims.z) * static_cast<std::uint64_t>(frames.count);
    const std::uint64_t bytes = slices * slice;
    const bool isLarge = bytes > kMostSmall;
    std::string text = descriptionOf(frames);
    text.resize(text.size() + 1); // it ends with a zero
    const std::size_t letters = text.size();
    const std::uint64_t header = isLarge ? 16 : 8, first = (header + letters + 15) / 16 * 16; // of the values
    text.resize(static_cast<std::size_t>(first - header));
    const std::uint64_t pages = (first + bytes + 15) / 16 * 16;
    writeAtomically(path, [&](OutputFile& out) {
        const auto put = [&](auto number) { out.write(&number, sizeof number); };
        out.write(std::endian::native == std::endian::little ? "II" : "MM");
        if (isLarge) {
            put(std::uint16_t{43});
            put(std::uint16_t{8}); // bytes of an offset
            put(std::uint16_t{0});
            put(pages);
        } else {
            put(std::uint16_t{42});
            put(static_cast<std::uint32_t>(pages));
        }
        out.write(text);
        writeFrames(out, frames, job);
        out.write(std::string(static_cast<std::size_t>(pages - first - bytes), '\0'));
        std::uint64_t at = pages;
        for (std::uint64_t n = 0; n < slices; ++n) {
            Directory page = pageOf(frames, isLarge, first + n * slice, n == 0 ? header : 0, letters);
            at += page.size();
            out.write(page.bytes(n + 1 < slices ? at : 0));
        }
    });
}

std::vector<std::string> losses(const FramesToWrite& frames, const std::string&) {
    const Geometry& g = frames.geometry;
    std::vector<std::string> lost;
    if (g.directions != Mat3(1) || g.origin != Vec3(0) || g.worldAxes != WorldAxes::File)
        lost.emplace_back("TIFF says how far voxels are from each other, but not where they lie in the world");
    if (frames.times && timeUnit(frames.times->unit).empty())
        lost.emplace_back("TIFF keeps times in seconds, milliseconds or microseconds only: these are lost");
    else if (frames.times && frames.times->first != 0)
        lost.emplace_back("TIFF does not say when the first frame is: times begin at 0");
    return lost;
}

} // namespace

VolumeWriter tiffWriter() { return {"TIFF", {".tif", ".tiff"}, write, losses}; }

} // namespace pellucid
