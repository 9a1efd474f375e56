#include "volume/formats/samples.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <type_traits>
#include <utility>
#include <variant>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "base/error.h"
#include "base/zeroed_memory.h"
#include "volume/formats/byte_source.h"
#include "volume/formats/bzip2_bytes.h"
#include "volume/formats/deflate_at_once.h"
#include "volume/formats/file_check.h"
#include "volume/formats/inflate_index.h"
#include "volume/spacing.h"

namespace pellucid {

namespace {

/// 64-bit integers have no sample type of their own.
template <class T>
using KeptType = std::conditional_t<std::is_integral_v<T> && sizeof(T) == 8, double, T>;
/// Whether floats have all scaled values of an integer type and tell them apart: their steps are no longer than those
/// of the values.
template <class T>
bool floatsTellApart(const ValueScaling& scaling) {
    const double step = std::abs(scaling.slope), most = std::ldexp(step, 8 * sizeof(T)) + std::abs(scaling.intercept);
    return most <= std::ldexp(step, std::numeric_limits<float>::digits) &&
           most <= static_cast<double>(std::numeric_limits<float>::max());
}

/// Calls use(Kept{}) with the type that values of T are kept in: their own, or scaled, since scaled integers are no
/// integers, the shortest that keeps them.
template <class T, class Use>
void withKeptType(const std::optional<ValueScaling>& scaling, const Use& use) {
    if (!scaling) return use(KeptType<T>{});
    if constexpr (sizeof(T) < sizeof(float)) {
        if (floatsTellApart<T>(*scaling)) return use(float{});
    } else if constexpr (std::is_same_v<T, float>) {
        return use(float{});
    }
    use(double{});
}

template <class T>
SampleType sampleTypeOf() {
    return static_cast<SampleType>(Samples(SampleArray<T>()).index());
}

/// Which values of the file make the volume: place of voxel (i,j,k) is first + i·stride.x + j·stride.y + k·stride.z,
/// which grows with the voxel's index.
struct Selection {
    Int3 dims{1, 1, 1};
    std::array<std::uint64_t, 3> stride{1, 1, 1};
    std::uint64_t first = 0;
    std::uint64_t components = 1, steps = 1;
    bool stepsAreApart = true; ///< each step lies behind the whole of the one before
};

Selection selectionOf(const FileLayout& layout, int component, int step) {
    Selection selection;
    std::uint64_t stride = 1;
    auto ofSteps = static_cast<std::uint64_t>(std::max(step, 0)); // what is left of it for slower axes
    std::size_t spatial = 0;
    for (const FileAxis& axis : layout.axes) {
        const auto size = static_cast<std::uint64_t>(axis.size);
        if (axis.components) {
            selection.components = size;
            const auto named = static_cast<std::size_t>(std::max(component, 0));
            const bool ordered = named < layout.componentOrder.size();
            selection.first += stride * (ordered ? static_cast<std::uint64_t>(layout.componentOrder[named]) : named);
            selection.stepsAreApart = selection.stepsAreApart && selection.steps == 1;
        } else if (spatial < 3 && !axis.time) {
            selection.stepsAreApart = selection.stepsAreApart && selection.steps == 1;
            selection.dims[static_cast<int>(spatial)] = static_cast<int>(axis.size);
            selection.stride[spatial++] = stride;
        } else {
            selection.steps *= size;
            selection.first += stride * (ofSteps % size);
            ofSteps /= size;
        }
        stride *= size;
    }
    for (; spatial < 3; ++spatial) // an axis of one voxel continues the one before it
        selection.stride[spatial] = spatial == 0
                                        ? 1
                                        : selection.stride[spatial - 1] *
                                              static_cast<std::uint64_t>(selection.dims[static_cast<int>(spatial) - 1]);
    return selection;
}

[[noreturn]] void failEarly(const std::string& path, std::uint64_t bytes) {
    throw FileError("the data cannot be read beyond " + std::to_string(bytes) + " decoded bytes", path,
                    "the file may be damaged, write or copy it again");
}

/// The values of a file as bytes of this machine, one after the other.
class Values {
public:
    virtual ~Values() = default;
    virtual void read(char* to, std::size_t values) = 0;
    virtual void skip(std::uint64_t values) = 0;
    /// Behind the last read: throws FileError unless what was read is sound.
    virtual void finish() {}
};

/// Whether all values of a stream are wanted, so that it may be unpacked in one go.
enum class Wanted { Some, All };

/// Whether the bytes of a T are in the other order than this machine has them.
template <class T>
bool isInOtherOrder(const StoredValues& stored) {
    return sizeof(T) > 1 && stored.bigEndian != (std::endian::native == std::endian::big);
}

/// The bytes of each T in reverse.
template <class T>
void swapBytes(char* bytes, std::size_t count) {
    for (char* value = bytes; value != bytes + count; value += sizeof(T)) {
        std::array<char, sizeof(T)> swapped;
        for (std::size_t i = 0; i < sizeof(T); ++i) swapped[i] = value[sizeof(T) - 1 - i];
        std::memcpy(value, swapped.data(), sizeof(T));
    }
}

template <class T>
class BinaryValues final : public Values {
public:
    BinaryValues(const StoredValues& stored, Wanted wanted, const JobControl& job)
        : m_path(stored.dataPath), m_swap(isInOtherOrder<T>(stored)), m_unchecked(stored.unchecked) {
        if (stored.open)
            m_bytes = stored.open(job);
        else if (stored.encoding == Encoding::Deflate && stored.index)
            m_bytes = stored.index->bytes(job);
        else if (stored.encoding == Encoding::Deflate || stored.encoding == Encoding::Bzip2)
            openPacked(stored, wanted, job);
        else if (stored.encoding == Encoding::Hex)
            m_bytes = std::make_unique<HexBytes>(m_path, stored.start, job);
        else
            m_bytes = std::make_unique<FileBytes>(m_path, stored.start, job);
        if (!m_bytes->skip(stored.skip)) fail(0);
    }
    void read(char* to, std::size_t values) override {
        const std::size_t bytes = values * sizeof(T);
        const std::size_t there = m_bytes->read(to, bytes);
        if (there < bytes) fail(m_done + there);
        m_done += bytes;
        if (m_swap) swapBytes<T>(to, bytes);
    }
    void skip(std::uint64_t values) override {
        if (values > 0 && !m_bytes->skip(values * sizeof(T))) fail(m_done);
        m_done += values * sizeof(T);
    }
    void finish() override {
        if (!m_unchecked) return;
        if (!m_unchecked->toEnd) return requireSound(*m_packed, m_unchecked->bytes, m_path);
        const std::uint64_t all = requireSoundToEnd(*m_packed, m_unchecked->bytes, m_path);
        if (all != m_unchecked->bytes)
            throw FileError("the file unpacks to " + std::to_string(all) + " bytes, of which its layout takes " +
                                std::to_string(m_unchecked->bytes),
                            m_path, "correct its layout", Remedy::CorrectRawLayout);
    }

private:
    void openPacked(const StoredValues& stored, Wanted wanted, const JobControl& job) {
        std::unique_ptr<UnpackedBytes> bytes;
        if (m_unchecked && wanted == Wanted::All && stored.encoding == Encoding::Deflate)
            bytes = unpackedAtOnce(m_path, stored.start, stored.zlib, m_unchecked->bytes, m_unchecked->toEnd, job);
        if (!bytes) bytes = unpackedBytes(stored, job);
        m_packed = bytes.get();
        m_bytes = std::move(bytes);
    }
    [[noreturn]] void fail(std::uint64_t bytes) const {
        if (m_unchecked) failToUnpack(*m_packed, m_unchecked->bytes, m_path);
        failEarly(m_path, bytes);
    }

    std::string m_path;
    bool m_swap;
    std::optional<UncheckedBytes> m_unchecked;
    std::unique_ptr<ByteSource> m_bytes;
    UnpackedBytes* m_packed = nullptr; // m_bytes, where they are unpacked
    std::uint64_t m_done = 0;
};

/// Numbers written out, in which byte order has no say.
template <class T>
class TextValues final : public Values {
public:
    TextValues(const StoredValues& stored, const JobControl& job)
        : m_path(stored.dataPath), m_words(stored.dataPath, stored.start, job) {}
    void read(char* to, std::size_t values) override {
        for (std::size_t i = 0; i < values; ++i) {
            const T value = next();
            std::memcpy(to + i * sizeof(T), &value, sizeof(T));
        }
    }
    void skip(std::uint64_t values) override {
        for (; values > 0; --values)
            if (!m_words.next(m_word)) failEarly(m_path, m_done);
    }

private:
    T next() {
        if (!m_words.next(m_word)) failEarly(m_path, m_done);
        m_done += sizeof(T);
        double value = 0;
        if constexpr (std::is_integral_v<T>) {
            std::int64_t whole = 0; // exact where a double is not
            if (parseNumber(m_word, whole) && std::in_range<T>(whole)) return static_cast<T>(whole);
            // Bounds as powers of two, which a double holds exactly: [−2^(b−1), 2^(b−1)) or [0, 2^b).
            const double end = std::ldexp(1.0, std::numeric_limits<T>::digits);
            const bool isWhole = parseNumber(m_word, value) && std::trunc(value) == value; // 3.0, 1e3
            if (!isWhole || !(value >= (std::is_signed_v<T> ? -end : 0.0)) || value >= end)
                throw FileError("the value " + inQuotes(m_word) + " does not fit the type of the samples", m_path,
                                "correct the type in the header");
            return static_cast<T>(value);
        } else {
            if (!parseNumber(m_word, value))
                throw FileError("there is " + inQuotes(m_word) + " where a number belongs", m_path,
                                "copy or write the file again");
            if (std::isfinite(value) && std::abs(value) > static_cast<double>(std::numeric_limits<T>::max()))
                throw FileError("the value " + inQuotes(m_word) + " does not fit the type of the samples", m_path,
                                "correct the type in the header");
            return static_cast<T>(value);
        }
    }

    std::string m_path, m_word;
    TextWords m_words;
    std::uint64_t m_done = 0;
};

template <class T>
std::unique_ptr<Values> openStored(const StoredValues& stored, Wanted wanted, const JobControl& job) {
    if (stored.encoding == Encoding::Text) return std::make_unique<TextValues<T>>(stored, job);
    return std::make_unique<BinaryValues<T>>(stored, wanted, job);
}

/// Those of several files, one file after the other. Files that are passed over stay closed.
template <class T>
class PartValues final : public Values {
public:
    /// `each`: values of one part.
    PartValues(const std::vector<StoredValues>& parts, std::uint64_t each, Wanted wanted, const JobControl& job)
        : m_parts(parts), m_each(each), m_wanted(wanted), m_job(job) {}
    void read(char* to, std::size_t values) override {
        while (values > 0) {
            goToPart();
            const auto piece = static_cast<std::size_t>(std::min<std::uint64_t>(values, m_each - m_at % m_each));
            m_values->read(to, piece);
            m_at += piece;
            m_openAt = m_at;
            to += piece * sizeof(T);
            values -= piece;
        }
    }
    void skip(std::uint64_t values) override { m_at += values; }
    void finish() override {
        if (m_values) m_values->finish();
    }

private:
    /// Opens the part that has the value m_at, and passes over those before it.
    void goToPart() {
        const std::uint64_t part = m_at / m_each;
        if (!m_values || part != m_part) {
            finish();
            m_values = openStored<T>(m_parts.at(static_cast<std::size_t>(part)), m_wanted, m_job);
            m_part = part;
            m_openAt = part * m_each;
        }
        m_values->skip(m_at - m_openAt);
        m_openAt = m_at;
    }

    const std::vector<StoredValues>& m_parts;
    const std::uint64_t m_each;
    const Wanted m_wanted;
    const JobControl& m_job;
    std::unique_ptr<Values> m_values;     // of m_part
    std::uint64_t m_at = 0, m_openAt = 0; // the next value of all, and the one that m_values comes to next
    std::uint64_t m_part = 0;
};

template <class T>
std::unique_ptr<Values> openValues(const FileLayout& layout, Wanted wanted, const JobControl& job) {
    if (layout.parts.empty()) return openStored<T>(layout, wanted, job);
    const std::uint64_t each = valuesIn(layout, layout.dataPath) / layout.parts.size();
    return std::make_unique<PartValues<T>>(layout.parts, each, wanted, job);
}

/// Hands out the values of voxels that follow each other at one stride, in the order of the file.
template <class T>
class VoxelReader {
public:
    VoxelReader(Values& values, std::uint64_t stride)
        // Voxels lie close together: read what is between them, too. Far apart: pass over it.
        : m_values(values), m_stride(stride),
          m_pieceVoxels(stride <= 4096 ? std::max<std::uint64_t>(1, kPieceBytes / (stride * sizeof(T))) : 1) {}

    /// Calls body(values, voxels) for pieces of the `length` voxels from the file's value `start` on; values of voxels
    /// are a stride apart.
    template <class Body>
    void readLine(std::uint64_t start, std::uint64_t length, const Body& body) {
        for (std::uint64_t i = 0; i < length;) {
            m_values.skip(start + i * m_stride - m_at);
            const std::uint64_t voxels = std::min(m_pieceVoxels, length - i);
            const std::uint64_t span = (voxels - 1) * m_stride + 1;
            m_piece.resize(static_cast<std::size_t>(span));
            m_values.read(reinterpret_cast<char*>(m_piece.data()), m_piece.size());
            body(m_piece.data(), voxels);
            m_at = start + i * m_stride + span;
            i += voxels;
        }
    }

    /// The same of voxels that lie beside each other, straight to `to`.
    void readTo(T* to, std::uint64_t start, std::uint64_t length) {
        m_values.skip(start - m_at);
        m_values.read(reinterpret_cast<char*>(to), static_cast<std::size_t>(length));
        m_at = start + length;
    }

private:
    static constexpr std::uint64_t kPieceBytes = 4u << 20;
    Values& m_values;
    std::uint64_t m_stride, m_pieceVoxels;
    std::vector<T> m_piece;
    std::uint64_t m_at = 0; ///< the next value of the file
};

/// Says from time to time how far reading has come.
class ReadProgress {
public:
    ReadProgress(const JobControl& job, std::size_t all) : m_job(job), m_all(all) {}
    void add(std::size_t voxels) {
        m_done += voxels;
        if (m_done < m_nextReport) return;
        m_job.throwIfStopped();
        m_job.report(0.1 + 0.8 * static_cast<double>(m_done) / static_cast<double>(m_all));
        m_nextReport = m_done + (1u << 20);
    }

private:
    const JobControl& m_job;
    std::size_t m_all, m_done = 0, m_nextReport = 0;
};

/// What readSamples() makes a volume of.
struct Collected {
    Samples samples;
    ValueRange range; ///< of the voxels that were read, where the volume has others; lo > hi where it has not
};

/// convert(T) of each voxel's value.
template <class T, class Kept, class Convert>
Collected collect(Values& values, const Selection& selection, const JobControl& job, const Convert& convert) {
    const auto size = [&](int a) { return static_cast<std::uint64_t>(selection.dims[a]); };
    // Voxels follow each other at one stride for as many axes as the file allows.
    std::uint64_t length = size(0), ny = size(1), nz = size(2);
    if (selection.stride[1] == size(0) * selection.stride[0]) {
        length *= std::exchange(ny, 1);
        if (selection.stride[2] == size(1) * selection.stride[1]) length *= std::exchange(nz, 1);
    }
    ZeroedVector<Kept> kept(voxelCount(selection.dims));
    std::size_t done = 0;
    VoxelReader<T> reader(values, selection.stride[0]);
    ReadProgress progress(job, kept.size());
    for (std::uint64_t k = 0; k < nz; ++k)
        for (std::uint64_t j = 0; j < ny; ++j)
            reader.readLine(selection.first + j * selection.stride[1] + k * selection.stride[2], length,
                            [&](const T* piece, std::uint64_t voxels) {
                                for (std::uint64_t v = 0; v < voxels; ++v)
                                    kept[done++] = convert(piece[v * selection.stride[0]]);
                                progress.add(static_cast<std::size_t>(voxels));
                            });
    values.finish();
    return {std::move(kept), {0, -1}};
}

/// The same where values are kept as the file has them and lie beside each other: nothing stands between file and
/// samples.
template <class T>
Collected collectPlain(Values& values, const Selection& selection, const JobControl& job) {
    ZeroedVector<T> kept(voxelCount(selection.dims));
    values.skip(selection.first);
    ReadProgress progress(job, kept.size());
    constexpr std::size_t kAtOnce = std::size_t{1} << 20;
    for (std::size_t done = 0; done < kept.size();) {
        const std::size_t count = std::min(kAtOnce, kept.size() - done);
        values.read(reinterpret_cast<char*>(kept.data() + done), count);
        done += count;
        progress.add(count);
    }
    values.finish();
    return {std::move(kept), {0, -1}};
}

/// The same of all that a deflate stream has, unpacked in one go straight to the samples; empty where that cannot be.
template <class T>
std::optional<Collected> collectAtOnce(const FileLayout& layout, const Selection& selection, const JobControl& job) {
    const std::uint64_t bytes = layout.skip + voxelCount(selection.dims) * sizeof(T);
    if (!layout.unchecked || layout.unchecked->bytes != bytes || bytes > kMostAtOnce || !layout.parts.empty() ||
        layout.open || layout.encoding != Encoding::Deflate || isInOtherOrder<T>(layout))
        return {};
    const std::size_t voxels = voxelCount(selection.dims);
    ZeroedVector<T> kept(voxels + static_cast<std::size_t>((layout.skip + sizeof(T) - 1) / sizeof(T)));
    auto* const first = reinterpret_cast<char*>(kept.data());
    if (!unpackAtOnce(layout.dataPath, layout.start, layout.zlib, layout.unchecked->toEnd,
                      {first, static_cast<std::size_t>(bytes)}, job))
        return {};
    if (layout.skip > 0) std::memmove(first, first + layout.skip, voxels * sizeof(T));
    kept.resize(voxels);
    return Collected{std::move(kept), {0, -1}};
}

/// Whether the voxels lie one behind the other.
bool isGapless(const Selection& selection) {
    const auto nx = static_cast<std::uint64_t>(selection.dims.x), ny = static_cast<std::uint64_t>(selection.dims.y);
    return selection.stride[0] == 1 && selection.stride[1] == nx && selection.stride[2] == nx * ny;
}

/// Rows of a volume, which are asked for in the order of the file.
template <class T>
class Rows {
public:
    virtual ~Rows() = default;
    /// The values of `rows` rows of `count` voxels along x, from `first` on, one row behind the other.
    virtual void read(const Int3& first, int count, int rows, T* to) = 0;
    /// Behind the last read: throws FileError unless what was read is sound.
    virtual void finish() {}
};

template <class T>
class StoredRows final : public Rows<T> {
public:
    StoredRows(std::unique_ptr<Values> values, const Selection& selection)
        : m_values(std::move(values)), m_selection(selection), m_reader(*m_values, selection.stride[0]) {}
    void read(const Int3& first, int count, int rows, T* to) override {
        const auto& stride = m_selection.stride;
        std::uint64_t start = m_selection.first;
        for (int a = 0; a < 3; ++a) start += static_cast<std::uint64_t>(first[a]) * stride[static_cast<std::size_t>(a)];
        const auto length = static_cast<std::uint64_t>(count);
        if (stride[0] == 1 && stride[1] == length)
            return m_reader.readTo(to, start, length * static_cast<std::uint64_t>(rows));
        // Rows that are close together: with what is between them, which is quicker than one by one.
        const bool close = stride[0] == 1 && stride[1] <= 4 * length;
        const int atOnce = close ? static_cast<int>(std::clamp<std::uint64_t>(kValuesAtOnce / stride[1], 1, 4096)) : 1;
        for (int row = 0; row < rows; row += atOnce) {
            const auto piece = static_cast<std::uint64_t>(std::min(atOnce, rows - row));
            readSome(start + static_cast<std::uint64_t>(row) * stride[1], length, piece, to);
            to += length * piece;
        }
    }
    void finish() override { m_values->finish(); }

private:
    static constexpr std::uint64_t kValuesAtOnce = (std::uint64_t{1} << 18) / sizeof(T); // they stay in the cache

    /// `rows` rows of `length` voxels from the file's value `start` on.
    void readSome(std::uint64_t start, std::uint64_t length, std::uint64_t rows, T* to) {
        const auto& stride = m_selection.stride;
        if (rows > 1) {
            m_span.resize(static_cast<std::size_t>((rows - 1) * stride[1] + length));
            m_reader.readTo(m_span.data(), start, m_span.size());
            for (std::uint64_t row = 0; row < rows; ++row)
                to = std::copy_n(m_span.data() + row * stride[1], length, to);
        } else if (stride[0] == 1) {
            m_reader.readTo(to, start, length);
        } else {
            m_reader.readLine(start, length, [&](const T* piece, std::uint64_t voxels) {
                for (std::uint64_t v = 0; v < voxels; ++v) *to++ = piece[v * stride[0]];
            });
        }
    }

    std::unique_ptr<Values> m_values;
    Selection m_selection;
    VoxelReader<T> m_reader;
    std::vector<T> m_span; // rows with what is between them
};

/// Of a volume in pieces. A piece is open from its first row to its last one, unless there are too many: then it is
/// opened anew for each layer.
template <class T>
class PieceRows final : public Rows<T> {
public:
    /// `whole`: of the volume.
    PieceRows(const std::vector<FilePiece>& pieces, const Selection& whole, const JobControl& job)
        : m_whole(whole), m_job(job) {
        for (const FilePiece& piece : pieces) m_pieces.push_back({&piece, nullptr});
    }
    void read(const Int3& first, int count, int rows, T* to) override {
        for (int row = 0; row < rows; ++row, to += count) readRow(first + Int3(0, row, 0), count, to);
    }

private:
    static constexpr std::size_t kMostOpen = 256; // a process may have 1024 files open
    struct Piece {
        const FilePiece* file;
        std::unique_ptr<StoredRows<T>> rows; ///< null: it is not open
    };

    void readRow(const Int3& first, int count, T* to) {
        if (first.z != m_layer) goToLayer(first.z);
        for (Piece* piece : m_inLayer) {
            const VoxelRegion& region = piece->file->region;
            const int begin = std::max(first.x, region.lo.x), end = std::min(first.x + count, region.hi.x);
            if (begin >= end || !hasRow(*piece, first.y)) continue;
            if (!piece->rows) open(*piece, first.y);
            piece->rows->read(Int3(begin, first.y, first.z) - piece->file->first, end - begin, 1,
                              to + (begin - first.x));
        }
    }
    static bool hasRow(const Piece& piece, int y) {
        return y >= piece.file->region.lo.y && y < piece.file->region.hi.y;
    }
    void goToLayer(int z) {
        m_layer = z;
        m_inLayer.clear();
        for (Piece& piece : m_pieces) {
            const bool isIn = z >= piece.file->region.lo.z && z < piece.file->region.hi.z;
            if (isIn) m_inLayer.push_back(&piece);
            if (!isIn) close(piece);
        }
    }
    void open(Piece& piece, int y) {
        for (std::size_t i = 0; m_open >= kMostOpen && i < m_inLayer.size(); ++i)
            if (!hasRow(*m_inLayer[i], y)) close(*m_inLayer[i]);
        Selection selection = m_whole; // its component, and how many there are
        const Int3& dims = piece.file->dims;
        selection.stride[0] = m_whole.components;
        selection.stride[1] = selection.stride[0] * static_cast<std::uint64_t>(dims.x);
        selection.stride[2] = selection.stride[1] * static_cast<std::uint64_t>(dims.y);
        piece.rows = std::make_unique<StoredRows<T>>(openStored<T>(piece.file->values, Wanted::Some, m_job), selection);
        ++m_open;
    }
    void close(Piece& piece) {
        m_open -= piece.rows ? 1u : 0u;
        piece.rows.reset();
    }

    const Selection m_whole;
    const JobControl& m_job;
    std::vector<Piece> m_pieces;
    std::vector<Piece*> m_inLayer; // those with voxels in m_layer
    int m_layer = -1;
    std::size_t m_open = 0;
};

/// Where each value is stored as it is in memory: raw, in this machine's byte order, in one file.
bool isPlain(const FileLayout& layout) {
    const bool native =
        bytesPerValue(layout.type) == 1 || layout.bigEndian == (std::endian::native == std::endian::big);
    return layout.encoding == Encoding::Raw && !layout.open && layout.parts.empty() && layout.pieces.empty() && native;
}

/// Of a large file whose values are stored as they are in memory: copied from a window of it that is mapped, so that
/// what lies between the rows is not. Where a window cannot be mapped, rows are read.
template <class T>
class MappedRows final : public Rows<T> {
public:
    MappedRows(const FileLayout& layout, const Selection& selection, const VoxelRegion& region, const JobControl& job)
        : m_layout(layout), m_selection(selection), m_job(job), m_end(byteOf(region.hi - 1) + sizeof(T)) {}
    void read(const Int3& first, int count, int rows, T* to) override {
        for (int row = 0; row < rows; ++row, to += count) {
            const Int3 begin = first + Int3(0, row, 0);
            const unsigned char* from = m_stored ? nullptr : at(begin, static_cast<std::uint64_t>(count) * sizeof(T));
            if (from == nullptr) return stored().read(begin, count, rows - row, to);
            std::memcpy(to, from, static_cast<std::size_t>(count) * sizeof(T));
        }
    }
    void finish() override {
        if (m_stored) m_stored->finish();
    }

private:
    static constexpr std::uint64_t kWindow = 16u << 20; ///< bytes: they count where address space is limited

    std::uint64_t byteOf(const Int3& voxel) const {
        std::uint64_t value = m_selection.first;
        for (std::size_t a = 0; a < 3; ++a)
            value += static_cast<std::uint64_t>(voxel[static_cast<int>(a)]) * m_selection.stride[a];
        return m_layout.start + value * sizeof(T);
    }
    const unsigned char* at(const Int3& voxel, std::uint64_t bytes) {
        const std::uint64_t begin = byteOf(voxel);
        if (!m_window || begin < m_begin || begin + bytes > m_begin + m_window->size()) {
            m_window.reset(); // before there is another one
            m_window = MappedFile::map(m_layout.dataPath, begin, std::min(std::max(bytes, kWindow), m_end - begin));
            m_begin = begin;
        }
        return m_window ? m_window->data() + (begin - m_begin) : nullptr;
    }
    StoredRows<T>& stored() {
        if (!m_stored)
            m_stored = std::make_unique<StoredRows<T>>(openValues<T>(m_layout, Wanted::Some, m_job), m_selection);
        return *m_stored;
    }

    const FileLayout& m_layout;
    const Selection m_selection;
    const JobControl& m_job;
    std::uint64_t m_end, m_begin = 0; // bytes of the file: behind the last one, and where the window begins
    std::shared_ptr<const MappedFile> m_window;
    std::unique_ptr<StoredRows<T>> m_stored;
};

template <class T>
std::unique_ptr<Rows<T>> openRows(const FileLayout& layout, const Selection& selection, const VoxelRegion& region,
                                  const JobControl& job) {
    if (isPlain(layout) && selection.stride[0] == 1 && voxelCount(region.hi - region.lo) * sizeof(T) >= kMapBytes)
        return std::make_unique<MappedRows<T>>(layout, selection, region, job);
    if (layout.pieces.empty())
        return std::make_unique<StoredRows<T>>(openValues<T>(layout, Wanted::Some, job), selection);
    return std::make_unique<PieceRows<T>>(layout.pieces, selection, job);
}

/// collect() for an excerpt, and for pieces: one layer of it is in the making while the file goes by.
template <class T, class Kept, class Convert>
Collected collectExcerpt(Rows<T>& rows, const ExcerptPlan& plan, std::optional<double> missing, const JobControl& job,
                         const Convert& convert) {
    const Int3 lo = plan.region.lo, size = plan.region.hi - lo;
    // Padded, so that codes of 8 bits need no copy.
    ZeroedVector<Kept> kept(voxelCount(plan.dims) + SampleArray<Kept>::kPadding);
    const auto ofRow = static_cast<std::size_t>(size.x);
    const bool asItIs = plan.factors == Int3(1);
    constexpr bool kAsStored = std::is_same_v<Convert, std::identity>;
    const std::size_t layer = voxelCount({plan.dims.x, plan.dims.y, 1});
    constexpr int kVoxelsAtOnce = 1 << 18;
    const int rowsAtOnce = std::clamp(kVoxelsAtOnce / size.x, 1, size.y);
    const std::size_t atOnce = ofRow * static_cast<std::size_t>(rowsAtOnce);
    std::vector<T> values(kAsStored ? 0 : atOnce);
    std::vector<Kept> converted(asItIs ? 0 : atOnce);
    LayerMeans<Kept> means({size.x, size.y}, plan.factors, missing);
    ReadProgress progress(job, voxelCount(size));
    for (int k = 0; k < size.z; ++k) {
        for (int j = 0; j < size.y; j += rowsAtOnce) {
            const int count = std::min(rowsAtOnce, size.y - j);
            const std::size_t voxels = ofRow * static_cast<std::size_t>(count);
            Kept* const to =
                asItIs ? kept.data() + layer * static_cast<std::size_t>(k) + ofRow * static_cast<std::size_t>(j)
                       : converted.data();
            if constexpr (kAsStored) {
                rows.read(lo + Int3(0, j, k), size.x, count, to);
            } else {
                rows.read(lo + Int3(0, j, k), size.x, count, values.data());
                std::transform(values.data(), values.data() + voxels, to, convert);
            }
            for (int row = 0; row < count && !asItIs; ++row)
                means.add(converted.data() + static_cast<std::size_t>(row) * ofRow, j + row);
            progress.add(voxels);
        }
        if (asItIs) continue;
        if (k % plan.factors.z == plan.factors.z - 1 || k == size.z - 1)
            means.takeTo(kept.data() + layer * static_cast<std::size_t>(k / plan.factors.z));
    }
    rows.finish();
    return {SampleArray<Kept>(std::move(kept), voxelCount(plan.dims)), asItIs ? ValueRange{0, -1} : means.range()};
}

/// Where the samples can be used as they lie in the file.
bool isAsInMemory(const FileLayout& layout, const Selection& selection) {
    const auto bytes = bytesPerValue(layout.type);
    return isPlain(layout) && !layout.scaling && isGapless(selection) &&
           (layout.start + selection.first * bytes) % bytes == 0;
}

/// The samples of whole layers as they lie in a large file; empty where that cannot be.
template <class T>
std::optional<Samples> mapped(const FileLayout& layout, const Selection& selection, const ExcerptPlan& plan,
                              const JobControl& job) {
    const VoxelRegion& region = plan.region;
    const std::uint64_t bytes = voxelCount(plan.dims) * sizeof(T),
                        first = selection.first + static_cast<std::uint64_t>(region.lo.z) * selection.stride[2];
    const bool ofLayers = plan.dims == Int3(selection.dims.x, selection.dims.y, region.hi.z - region.lo.z);
    if (bytes < kMapBytes || !ofLayers || !isAsInMemory(layout, selection)) return {};
    auto file = MappedFile::map(layout.dataPath, layout.start + first * sizeof(T), bytes);
    if (!file) return {};
    // Looked at once from end to end, so that a slow disk can be waited for, or not.
    constexpr std::size_t kPage = 4096;
    ReadProgress progress(job, file->size());
    volatile unsigned char looked = 0;
    for (std::size_t i = 0; i < file->size(); i += kPage) {
        looked = file->data()[i];
        progress.add(kPage);
    }
    static_cast<void>(looked);
    return SampleArray<T>(std::move(file));
}

template <class T, class Kept>
Collected readAs(const FileLayout& layout, const Selection& selection, const ExcerptPlan& plan,
                 const VolumeSource& source, const JobControl& job) {
    if constexpr (std::is_same_v<T, Kept>)
        if (auto samples = mapped<T>(layout, selection, plan, job)) return {std::move(*samples), {0, -1}};
    if (plan.isWhole()) { // it was not planned for memory where it was to be mapped
        const std::uint64_t bytes = voxelCount(plan.dims) * sizeof(Kept);
        requireMemory(source.then, source.path, plan.dims, sampleTypeOf<Kept>(), bytes, bytes);
    }
    const bool byRows = !plan.isWhole() || !layout.pieces.empty();
    if constexpr (std::is_same_v<T, Kept>)
        if (!byRows && !layout.scaling && isGapless(selection)) {
            if (auto all = collectAtOnce<T>(layout, selection, job)) return std::move(*all);
            return collectPlain<T>(*openValues<T>(layout, Wanted::All, job), selection, job);
        }
    const auto read = [&](const auto& convert) {
        return byRows ? collectExcerpt<T, Kept>(*openRows<T>(layout, selection, plan.region, job), plan, source.missing,
                                                job, convert)
                      : collect<T, Kept>(*openValues<T>(layout, Wanted::All, job), selection, job, convert);
    };
    if constexpr (std::is_same_v<T, Kept>)
        if (!layout.scaling) return read(std::identity());
    if (!layout.scaling) return read([](T value) { return static_cast<Kept>(value); });
    bool isBeyond = false;
    Collected scaled = read([scaling = *layout.scaling, &isBeyond](T value) {
        const double exact = scaling.slope * static_cast<double>(value) + scaling.intercept;
        isBeyond |=
            std::isfinite(static_cast<double>(value)) && !(std::abs(exact) <= double{std::numeric_limits<Kept>::max()});
        return isBeyond ? Kept{0} : static_cast<Kept>(exact);
    });
    if (isBeyond)
        throw FileError("some values, scaled as the header says, are larger than samples of this type can be",
                        source.path, "correct the scaling in the header");
    return scaled;
}

/// Whether packed data may be unpacked into as much memory as the header claims before it has been checked: not much,
/// or what the stream says itself, or what such data usually unpacks to.
bool isBelievable(const StoredValues& values, std::uint64_t stored, std::uint64_t bytes) {
    constexpr std::uint64_t kLittle = 256u << 20, kUsual = 8;
    return bytes <= kLittle || bytes / kUsual <= stored ||
           (values.encoding == Encoding::Deflate && lengthAtEnd(values.dataPath) == bytes % (std::uint64_t{1} << 32));
}

} // namespace

std::uint64_t bytesPerValue(ValueType type) {
    return withType(type, [](auto zero) { return static_cast<std::uint64_t>(sizeof zero); });
}

std::uint64_t valuesIn(const FileLayout& layout, const std::string& path) {
    std::vector<std::int64_t> sizes;
    for (const FileAxis& axis : layout.axes) sizes.push_back(axis.size);
    return valueCount(path, sizes, sizeof(double));
}

std::uint64_t valuesUpTo(const FileLayout& layout, int step) {
    const Selection selection = selectionOf(layout, 0, 0);
    const std::uint64_t all = valuesIn(layout, layout.dataPath);
    if (!selection.stepsAreApart) return all;
    return all / selection.steps *
           std::min<std::uint64_t>(static_cast<std::uint64_t>(std::max(step, 0)) + 1, selection.steps);
}

void requireData(FileLayout& layout, std::uint64_t stored, std::uint64_t wanted, const char* toDo,
                 const JobControl& job) {
    const std::uint64_t bytesPer = bytesPerValue(layout.type), bytes = layout.skip + wanted * bytesPer;
    const std::uint64_t all = valuesIn(layout, layout.dataPath) * bytesPer;
    requireStored(layout.dataPath, layout.encoding, wanted, bytesPer, stored, toDo);
    if (layout.encoding == Encoding::Text) {
        requireNumbers(layout.dataPath, layout.start, wanted, job);
    } else if (layout.encoding == Encoding::Bzip2 ||
               (layout.encoding == Encoding::Deflate && selectionOf(layout, 0, 0).steps == 1)) {
        if (isBelievable(layout, stored, bytes))
            layout.unchecked = UncheckedBytes{bytes};
        else
            requireSound(*unpackedBytes(layout, job), bytes, layout.dataPath);
    } else if (layout.encoding == Encoding::Deflate) {
        layout.index = InflateIndex::of(layout.dataPath, layout.start, layout.zlib);
        layout.index->require(bytes, job);
    } else if (layout.encoding == Encoding::Raw && stored > all) {
        layout.notices.push_back("the data has " + std::to_string(stored - all) + " bytes more than the header says");
    }
}

std::unique_ptr<UnpackedBytes> unpackedBytes(const StoredValues& stored, const JobControl& job) {
    if (stored.encoding == Encoding::Bzip2) return std::make_unique<Bunzipped>(stored.dataPath, stored.start, job);
    return std::make_unique<InflatedBytes>(stored.dataPath, stored.start, stored.zlib, job);
}

FileContents contentsOf(const FileLayout& layout) {
    constexpr std::uint64_t kMost = std::numeric_limits<int>::max();
    const Selection selection = selectionOf(layout, 0, 0);
    FileContents contents;
    contents.dims = selection.dims;
    withType(layout.type, [&](auto zero) {
        using T = decltype(zero);
        withKeptType<T>(layout.scaling, [&](auto kept) { contents.type = sampleTypeOf<decltype(kept)>(); });
    });
    contents.components = static_cast<int>(std::min(selection.components, kMost));
    contents.steps = static_cast<int>(std::min(selection.steps, kMost));
    contents.array = layout.array;
    contents.arrays = layout.arrays;
    if (!layout.times) return contents;
    contents.timeUnit = layout.times->unit;
    constexpr int kMostTimes = 1'000'000; // a damaged header may claim any number
    for (int step = 0; step < contents.steps && contents.steps <= kMostTimes; ++step)
        contents.times.push_back(layout.times->first + step * layout.times->width);
    return contents;
}

Vec3 cleanDirection(const Vec3& direction) {
    const double length = glm::length(direction);
    if (!(length > 0) || !std::isfinite(length)) return Vec3(0);
    Vec3 unit = direction / length;
    for (int a = 0; a < 3; ++a) {
        Vec3 axis(0);
        axis[a] = std::copysign(1.0, unit[a]);
        if (glm::length(unit - axis) < 1e-6) return axis;
    }
    return unit;
}

Volume readSamples(const VolumeSource& source, const FileLayout& layout, const JobControl& job) {
    const std::string& path = source.path;
    const Selection selection = selectionOf(layout, source.component, source.step);
    const Geometry geometry{selection.dims,    layout.spacing,   layout.origin,
                            layout.directions, layout.worldAxes, layout.lengthUnit};
    if (const std::string wrong = geometryProblem(geometry.spacing, geometry.origin); !wrong.empty())
        throw FileError(wrong, path, "correct the header, or write it in another unit");
    if (!(std::abs(glm::determinant(geometry.directions)) > 1e-6))
        throw FileError("the directions of the axes lie in one plane", path, "correct the header");
    requireIndex("component", source.component, selection.components, path);
    requireIndex("time step", source.step, selection.steps, path);
    if (!source.array.empty() && layout.array != source.array)
        throw UsageError("there is no array " + inQuotes(source.array), path,
                         "the file does not name its arrays: leave the name out");

    std::vector<std::string> notices = layout.notices;
    if (selection.components > 1)
        notices.push_back("component " + std::to_string(source.component) + " of " +
                          std::to_string(selection.components) + " is shown");

    job.report(0.1);
    job.throwIfStopped();
    Collected read;
    ExcerptPlan plan;
    withType(layout.type, [&](auto zero) {
        using T = decltype(zero);
        const auto readTo = [&](auto keptZero) {
            using Kept = decltype(keptZero);
            const bool inFile = std::is_same_v<T, Kept> && isAsInMemory(layout, selection) &&
                                voxelCount(selection.dims) * sizeof(Kept) >= kMapBytes;
            plan = layout.plan ? *layout.plan : planExcerpt(source, selection.dims, sampleTypeOf<Kept>(), inFile);
            read = readAs<T, Kept>(layout, selection, plan, source, job);
        };
        if (std::is_integral_v<T> && sizeof(T) == 8) notices.emplace_back("64-bit integers are kept as 64-bit floats");
        withKeptType<T>(layout.scaling, readTo);
    });
    job.report(0.9);
    Volume volume(plan.geometryOf(geometry), std::move(read.samples), source.missing);
    if (!plan.isWhole()) {
        volume = throughWindowOf(std::move(volume), read.range);
        volume.excerpt = plan.excerpt;
        const auto more = plan.notices();
        notices.insert(notices.begin(), more.begin(), more.end());
    }
    volume.notices = std::move(notices);
    return volume;
}

} // namespace pellucid
