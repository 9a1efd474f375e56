// The values of a volume's files one after the other, as bytes of this machine, whatever they are stored as.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/text.h"
#include "volume/formats/byte_source.h"
#include "volume/formats/deflate_at_once.h"
#include "volume/formats/file_check.h"
#include "volume/formats/inflate_index.h"
#include "volume/formats/samples.h"

namespace pellucid {

/// Which values of the file make the volume: place of voxel (i,j,k) is first + i·stride.x + j·stride.y + k·stride.z,
/// which grows with the voxel's index.
struct Selection {
    Int3 dims{1, 1, 1};
    std::array<std::uint64_t, 3> stride{1, 1, 1};
    std::uint64_t first = 0;
    std::uint64_t components = 1, steps = 1;
    bool stepsAreApart = true; ///< each step lies behind the whole of the one before

    std::uint64_t placeOf(const Int3& voxel) const; ///< among the values of the file
};

/// Of one component and step, both from 0, which need not be there.
Selection selectionOf(const FileLayout& layout, int component, int step);
/// Whether the voxels lie one behind the other.
bool isGapless(const Selection& selection);

/// Throws FileError: `bytes` of them could be decoded.
[[noreturn]] void failEarly(const std::string& path, std::uint64_t bytes);

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

} // namespace pellucid
