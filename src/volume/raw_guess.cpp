#include "volume/raw_guess.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <optional>
#include <span>
#include <tuple>

#include "base/mapped_file.h"
#include "base/text.h"
#include "volume/formats/content.h"
#include "volume/formats/file_check.h"
#include "volume/formats/inflate_index.h"

namespace pellucid {

namespace {

bool isDigit(char c) { return c >= '0' && c <= '9'; }
bool isLetter(char c) { return c >= 'a' && c <= 'z'; }

/// The number at `at` of a text, of five digits at most; goes behind it.
std::optional<int> numberAt(const std::string& text, std::size_t& at) {
    int number = 0;
    const std::size_t first = at;
    for (; at < text.size() && isDigit(text[at]); ++at)
        if (at - first < 6) number = 10 * number + (text[at] - '0');
    const std::size_t digits = at - first;
    return digits >= 1 && digits <= 5 ? std::optional(number) : std::nullopt;
}

/// Three numbers with "x" or "_" between them.
std::optional<Int3> dimsIn(const std::string& name) {
    for (std::size_t begin = 0; begin < name.size(); ++begin) {
        if (!isDigit(name[begin]) || (begin > 0 && isDigit(name[begin - 1]))) continue;
        Int3 dims(0);
        std::size_t at = begin;
        for (int a = 0; a < 3; ++a) {
            const auto number = numberAt(name, at);
            if (!number || *number < 1) break;
            const bool isSeparated = at < name.size() && (name[at] == 'x' || name[at] == '_');
            if (a < 2 && !isSeparated) break;
            dims[a] = *number;
            if (a < 2) ++at;
        }
        if (dims.z > 0) return dims;
    }
    return {};
}

/// "uint8", "u_16", "float32", "short", … as a word of its own.
std::optional<SampleType> typeIn(const std::string& name) {
    for (const auto& [word, letter] :
         {std::pair{"uint", 'u'}, {"int", 'i'}, {"u", 'u'}, {"i", 'i'}, {"s", 'i'}, {"float", 'f'}, {"f", 'f'}})
        for (std::size_t at = name.find(word); at != std::string::npos; at = name.find(word, at + 1)) {
            if (at > 0 && isLetter(name[at - 1])) continue;
            std::size_t end = at + std::string(word).size();
            if (end < name.size() && name[end] == '_') ++end;
            const auto bits = numberAt(name, end);
            if (!bits) continue;
            if (const auto type = findNamed<SampleType>(letter + std::to_string(*bits))) return type;
        }
    if (name.find("float") != std::string::npos) return SampleType::F32;
    if (name.find("ushort") != std::string::npos) return SampleType::U16;
    if (name.find("short") != std::string::npos) return SampleType::I16;
    return {};
}

std::string baseNameOf(const std::string& path) { return lowerCase(std::filesystem::path(path).stem().string()); }

/// Where the voxels lie that are looked at: in stretches, so that a large file is touched in few places.
constexpr std::size_t kStretches = 96, kStretch = 96;

/// Numbers that look drawn by lot, and are the same each time.
class Lot {
public:
    std::size_t below(std::size_t count) {
        m_state = m_state * 6364136223846793005u + 1442695040888963407u;
        return static_cast<std::size_t>((m_state >> 33) % count);
    }

private:
    std::uint64_t m_state = 1;
};

/// The values of a file, taken for one type in one byte order.
template <class T>
class Values {
public:
    Values(std::span<const unsigned char> bytes, bool swap) : m_bytes(bytes), m_swap(swap) {}
    std::size_t count() const { return m_bytes.size() / sizeof(T); }
    double at(std::size_t i) const {
        std::array<unsigned char, sizeof(T)> bytes;
        std::memcpy(bytes.data(), m_bytes.data() + i * sizeof(T), sizeof(T));
        if (m_swap) std::ranges::reverse(bytes);
        return static_cast<double>(std::bit_cast<T>(bytes));
    }

    /// Mean difference of voxels `lag` apart; infinite where they are no numbers.
    double difference(std::size_t lag) const {
        Lot lot;
        double sum = 0;
        std::size_t counted = 0, all = 0;
        for (std::size_t s = 0; s < kStretches; ++s) {
            if (lag >= count()) break;
            const std::size_t room = count() - lag, first = room > kStretch ? lot.below(room - kStretch) : 0;
            for (std::size_t i = first; i < first + std::min(kStretch, room); ++i, ++all) {
                const double d = std::abs(at(i) - at(i + lag));
                if (!std::isfinite(d) || d > 1e30) continue; // 1e35 marks voxels without data
                sum += d;
                ++counted;
            }
        }
        return 2 * counted > all ? sum / static_cast<double>(counted) : std::numeric_limits<double>::infinity();
    }
    /// Mean difference of voxels drawn by lot.
    double spread() const {
        Lot lot;
        double sum = 0;
        std::size_t counted = 0;
        for (std::size_t n = 0; n < kStretches * kStretch / 4; ++n) {
            const double d = std::abs(at(lot.below(count())) - at(lot.below(count())));
            if (!std::isfinite(d) || d > 1e30) continue;
            sum += d;
            ++counted;
        }
        return counted > 0 ? sum / static_cast<double>(counted) : 0;
    }

    /// Whether nearly all values are of a size that measured ones have: other bytes read as floats have any exponent.
    bool arePlausible() const {
        Lot lot;
        std::size_t odd = 0;
        constexpr std::size_t kLooked = 4096;
        for (std::size_t n = 0; n < kLooked && count() > 0; ++n) {
            const double size = std::abs(at(lot.below(count())));
            odd += size != 0 && std::isfinite(size) && (size < 1e-12 || (size > 1e12 && size < 1e30)) ? 1u : 0u;
        }
        return odd < kLooked / 20;
    }

private:
    std::span<const unsigned char> m_bytes;
    bool m_swap;
};

std::vector<int> divisorsOf(std::uint64_t number, int least, int most) {
    std::vector<int> divisors;
    for (int d = least; d <= most && static_cast<std::uint64_t>(d) <= number; ++d)
        if (number % static_cast<std::uint64_t>(d) == 0) divisors.push_back(d);
    return divisors;
}

class Guesser {
public:
    Guesser(std::span<const unsigned char> bytes, std::optional<Int3> dims, const JobControl& job)
        : m_bytes(bytes), m_dims(dims), m_job(job) {}

    /// False where the bytes cannot be of this type.
    template <class T>
    bool tryType(SampleType type, bool isBigEndian) {
        m_job.throwIfStopped();
        if (m_bytes.size() % sizeof(T) != 0 || m_bytes.empty()) return false;
        const Values<T> values(m_bytes, isBigEndian != (std::endian::native == std::endian::big));
        if (std::is_floating_point_v<T> && !values.arePlausible()) return false;
        const double spread = values.spread(), along = values.difference(1);
        const auto add = [&](const Int3& dims, double sum) {
            RawLayout layout;
            layout.dims = dims;
            layout.type = type;
            layout.bigEndian = isBigEndian;
            m_guesses.push_back({layout, spread > 0 ? 1 - sum / (3 * spread) : 0});
        };
        const std::uint64_t count = values.count();
        if (m_dims && voxelCount(*m_dims) == count) {
            const Int3 d = *m_dims;
            const auto row = static_cast<std::size_t>(d.x);
            add(d, along + values.difference(row) + values.difference(row * static_cast<std::size_t>(d.y)));
        }
        if (!(spread > 0) || !std::isfinite(spread) || !(along < kMostUneven * spread)) return false;
        // The rows whose neighbours agree best, then how many make a slice.
        std::vector<std::pair<double, int>> rows;
        for (const int nx : divisorsOf(count, kLeast, kMost))
            rows.emplace_back(values.difference(static_cast<std::size_t>(nx)), nx);
        std::ranges::sort(rows);
        rows.resize(std::min(rows.size(), kRowsTried));
        for (const auto& [across, nx] : rows) {
            m_job.throwIfStopped();
            for (const int ny : divisorsOf(count / static_cast<std::uint64_t>(nx), kLeast, kMost)) {
                const std::uint64_t slice = static_cast<std::uint64_t>(nx) * static_cast<std::uint64_t>(ny);
                const std::uint64_t nz = count / slice;
                if (nz < 2 || nz > kMost || std::max(nx, ny) > kMostLonger * std::min(nx, ny)) continue;
                add({nx, ny, static_cast<int>(nz)},
                    along + across + values.difference(static_cast<std::size_t>(slice)));
            }
        }
        return true;
    }

    /// The one of two types that differ in their sign alone in which neighbours are closer: small negative numbers,
    /// taken for unsigned ones, jump where they cross zero.
    template <class Unsigned, class Signed>
    void tryEither(SampleType asUnsigned, SampleType asSigned, bool isBigEndian) {
        const bool swap = isBigEndian != (std::endian::native == std::endian::big);
        const bool jumps = Values<Unsigned>(m_bytes, swap).difference(1) > Values<Signed>(m_bytes, swap).difference(1);
        if (jumps)
            tryType<Signed>(asSigned, isBigEndian);
        else
            tryType<Unsigned>(asUnsigned, isBigEndian);
    }

    std::vector<RawGuess> best(std::size_t most) {
        const auto isBetter = [&](const RawGuess& a, const RawGuess& b) {
            const auto isNamed = [&](const RawGuess& guess) { return m_dims && guess.layout.dims == *m_dims; };
            return std::tuple(isNamed(a), a.agreement) > std::tuple(isNamed(b), b.agreement);
        };
        std::ranges::stable_sort(m_guesses, isBetter);
        m_guesses.resize(std::min(m_guesses.size(), most));
        return std::move(m_guesses);
    }

private:
    static constexpr int kLeast = 4, kMost = 16384, kMostLonger = 32;
    static constexpr std::size_t kRowsTried = 16;
    static constexpr double kMostUneven = 0.8; ///< more along x is noise, or another type
    std::span<const unsigned char> m_bytes;
    std::optional<Int3> m_dims;
    const JobControl& m_job;
    std::vector<RawGuess> m_guesses;
};

/// The bytes of a file; of one packed by gzip, what it unpacks to.
class RawFile {
public:
    RawFile(const std::string& path, const JobControl& job) {
        m_count = readableFileBytes(path);
        if (m_count == 0) return;
        if (isGzip(path)) {
            const auto index = InflateIndex::of(path, 0, false);
            m_count = index->requireWhole(job);
            if (m_count > kMostUnpacked) return;
            m_unpacked.resize(static_cast<std::size_t>(m_count));
            index->bytes(job)->read(m_unpacked.data(), m_unpacked.size());
            m_bytes = {reinterpret_cast<const unsigned char*>(m_unpacked.data()), m_unpacked.size()};
            return;
        }
        m_mapped = MappedFile::map(path, 0, m_count);
        if (m_mapped) m_bytes = {m_mapped->data(), m_mapped->size()};
    }
    /// Empty where they cannot be looked at.
    std::span<const unsigned char> bytes() const { return m_bytes; }
    std::uint64_t count() const { return m_count; }

private:
    static constexpr std::uint64_t kMostUnpacked = 1u << 30;
    std::uint64_t m_count = 0;
    std::shared_ptr<const MappedFile> m_mapped;
    std::vector<char> m_unpacked;
    std::span<const unsigned char> m_bytes;
};

} // namespace

RawLayout rawLayoutInName(const std::string& path, std::uint64_t bytes) {
    RawLayout layout;
    const std::string name = baseNameOf(path);
    layout.type = typeIn(name).value_or(SampleType::U8);
    if (const auto dims = dimsIn(name)) {
        layout.dims = *dims;
        const std::uint64_t voxels = voxelCount(*dims);
        if (bytes == 2 * voxels && bytesPerSample(layout.type) != 2) layout.type = SampleType::U16;
        if (bytes == 4 * voxels && bytesPerSample(layout.type) != 4) layout.type = SampleType::F32;
        return layout;
    }
    const double voxels = static_cast<double>(bytes) / static_cast<double>(bytesPerSample(layout.type));
    layout.dims = Int3(std::max(1, static_cast<int>(std::lround(std::cbrt(voxels)))));
    return layout;
}

RawLook lookAtRaw(const std::string& path, std::size_t most, const JobControl& job) {
    const std::string name = baseNameOf(path);
    const std::optional<SampleType> named = typeIn(name);
    const RawFile file(path, job);
    Guesser guesser(file.bytes(), dimsIn(name), job);
    using enum SampleType;
    if (!named || named == U8) guesser.tryType<std::uint8_t>(U8, false);
    if (named == I8) guesser.tryType<std::int8_t>(I8, false);
    for (const bool isBigEndian : {false, true}) {
        if (named == U16) guesser.tryType<std::uint16_t>(U16, isBigEndian);
        if (named == I16) guesser.tryType<std::int16_t>(I16, isBigEndian);
        if (named == U32) guesser.tryType<std::uint32_t>(U32, isBigEndian);
        if (named == I32) guesser.tryType<std::int32_t>(I32, isBigEndian);
        if (!named) guesser.tryEither<std::uint16_t, std::int16_t>(U16, I16, isBigEndian);
        const bool isFloat = (!named || named == F32) && guesser.tryType<float>(F32, isBigEndian);
        const bool isDouble = (!named || named == F64) && guesser.tryType<double>(F64, isBigEndian);
        if (!named && !isFloat && !isDouble) guesser.tryEither<std::uint32_t, std::int32_t>(U32, I32, isBigEndian);
    }
    return {file.count(), guesser.best(most)};
}

std::string rawLayoutText(const RawLayout& layout) {
    const Int3 d = layout.dims;
    return std::to_string(d.x) + "," + std::to_string(d.y) + "," + std::to_string(d.z) + "," + name(layout.type) +
           (layout.bigEndian ? ",big" : "");
}

} // namespace pellucid
