#include "foreign/arrays/array_volume.h"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <set>

#include "base/check.h"
#include "base/text.h"

namespace pellucid {

namespace {

/// Read at once, where blocks are not larger.
constexpr std::uint64_t kPieceBytes = 32u << 20;
/// Names in a message.
constexpr std::size_t kMostNamed = 20;

/// "40 × 30 × 20, i16", fastest first.
std::string detailsOf(const ArrayVariable& variable) {
    std::string text;
    for (std::size_t a = variable.dims.size(); a-- > 0;)
        text += std::to_string(variable.dims[a]) + (a > 0 ? " × " : ", ");
    return text + variable.typeName;
}

std::string described(const ArrayVariable& variable) {
    return inQuotes(variable.name) + " (" + detailsOf(variable) + ")";
}

/// What a file has that is no volume.
std::string whatElse(const std::vector<ArrayVariable>& variables) {
    if (variables.empty()) return "it has no arrays at all";
    std::vector<std::string> all;
    for (const ArrayVariable& variable : variables)
        if (all.size() < kMostNamed) all.push_back(described(variable));
    return "it has " + joined(all) + (all.size() < variables.size() ? ", …" : "");
}

/// Arrays that say where the places of others are.
std::set<std::string> coordinateNames(const ArrayFile& file, const std::vector<const ArrayVariable*>& volumes) {
    std::set<std::string> names;
    for (const ArrayVariable* volume : volumes) {
        const std::string group = volume->name.substr(0, volume->name.rfind('/') + 1);
        for (const char* kind : {"coordinates", "bounds"})
            for (const std::string& name : splitWords(file.text(*volume, kind))) names.insert(group + name);
    }
    return names;
}

/// Goes on to the next piece of `whole`; false behind the last one.
bool goOn(ArrayBox& piece, const ArrayBox& whole, const std::vector<std::int64_t>& size) {
    for (std::size_t a = size.size(); a-- > 0;) {
        const std::int64_t end = whole.first[a] + whole.size[a], next = piece.first[a] + piece.size[a];
        piece.first[a] = next < end ? next : whole.first[a];
        // Pieces begin where blocks do.
        piece.size[a] = std::min(size[a] - piece.first[a] % size[a], end - piece.first[a]);
        if (next < end) return true;
    }
    return false;
}

/// Puts a piece where it belongs in all of a step.
void place(std::span<const std::byte> from, const ArrayBox& piece, const ArrayBox& whole, std::size_t width,
           std::span<std::byte> to) {
    const std::size_t row = static_cast<std::size_t>(piece.size.back()) * width;
    std::vector<std::int64_t> index = piece.first;
    for (std::size_t done = 0; done < from.size(); done += row) {
        std::size_t at = 0;
        for (std::size_t a = 0; a < index.size(); ++a)
            at = at * static_cast<std::size_t>(whole.size[a]) + static_cast<std::size_t>(index[a] - whole.first[a]);
        std::memcpy(to.data() + at * width, from.data() + done, row);
        for (std::size_t a = index.size() - 1; a-- > 0;) {
            if (++index[a] < piece.first[a] + piece.size[a]) break;
            index[a] = piece.first[a];
        }
    }
}

} // namespace

ArrayVolume::ArrayVolume(std::unique_ptr<ArrayFile> file, const std::string& path, const std::string& wanted)
    : m_file(std::move(file)), m_path(path), m_notices(m_file->notices()) {
    for (const ArrayVariable& variable : m_file->variables())
        if (variable.type && variable.dims.size() >= 3 && valuesIn(variable) > 0) m_volumes.push_back(&variable);
    choose(wanted);
    valueCount(path, m_chosen->dims, bytesPerValue(m_packed.type)); // throws where they are too many to count
}

void ArrayVolume::choose(const std::string& wanted) {
    if (!wanted.empty()) {
        const auto isMeant = [&](const ArrayVariable& variable) {
            const std::string name = printable(variable.name);
            return wanted == name || "/" + wanted == name;
        };
        const auto isLast = [&](const ArrayVariable& variable) {
            return printable(variable.name).ends_with("/" + wanted);
        };
        const auto& all = m_file->variables();
        auto found = std::ranges::find_if(all, isMeant);
        if (found == all.end() && std::ranges::count_if(all, isLast) == 1) found = std::ranges::find_if(all, isLast);
        std::vector<std::string> names;
        for (const ArrayVariable* volume : m_volumes)
            if (names.size() < kMostNamed) names.push_back(inQuotes(volume->name));
        const std::string there =
            names.empty() ? whatElse(all) : "there " + std::string(names.size() == 1 ? "is " : "are ") + joined(names);
        if (found == all.end()) throw UsageError("there is no array " + inQuotes(wanted), m_path, there);
        if (!found->type) throw UsageError(described(*found) + " has no numbers to be shown", m_path, there);
        if (std::ranges::find(m_volumes, &*found) == m_volumes.end())
            throw UsageError(described(*found) + " is no volume: that has three axes or more", m_path, there);
        return take(*found);
    }
    if (m_volumes.empty()) {
        const std::string notice = m_notices.empty() ? "" : ", and " + m_notices.front();
        throw FileError("no array in this file has numbers along three axes or more: " + whatElse(m_file->variables()) +
                            notice,
                        m_path, "name another file");
    }
    std::vector<const ArrayVariable*> byRank = m_volumes;
    const std::set<std::string> coordinates = coordinateNames(*m_file, m_volumes);
    std::ranges::stable_sort(byRank, [&](const ArrayVariable* a, const ArrayVariable* b) {
        const bool isOfA = coordinates.contains(a->name), isOfB = coordinates.contains(b->name);
        return isOfA != isOfB ? isOfB : valuesIn(*a) > valuesIn(*b);
    });
    std::optional<FileError> fault;
    for (const ArrayVariable* variable : byRank) {
        try {
            take(*variable);
            break;
        } catch (const FileError& error) {
            if (!fault) fault = error;
        }
    }
    if (m_chosen == nullptr) throw *fault;
    if (fault) m_notices.push_back(fault->problem() + ": another array is shown");
    if (m_volumes.size() > 1)
        m_notices.push_back("array " + inQuotes(m_chosen->name) + " of " + std::to_string(m_volumes.size()) +
                            " is shown");
}

void ArrayVolume::take(const ArrayVariable& variable) {
    const std::vector<std::string> odd = m_file->check(variable);
    m_axes = axesOf(*m_file, variable);
    m_packed = packedValuesOf(*m_file, variable);
    m_chosen = &variable;
    m_notices.insert(m_notices.end(), odd.begin(), odd.end());
    m_notices.insert(m_notices.end(), m_axes.notices.begin(), m_axes.notices.end());
    m_notices.insert(m_notices.end(), m_packed.notices.begin(), m_packed.notices.end());
}

std::uint64_t ArrayVolume::steps() const {
    std::uint64_t steps = 1;
    for (const std::size_t a : m_axes.steps) steps *= static_cast<std::uint64_t>(m_chosen->dims[a]);
    return steps;
}

ArrayBox ArrayVolume::boxOf(int step) const {
    ArrayBox box{std::vector<std::int64_t>(m_chosen->dims.size(), 0),
                 std::vector<std::int64_t>(m_chosen->dims.size(), 1)};
    for (const std::size_t a : m_axes.places) box.size[a] = m_chosen->dims[a];
    if (m_axes.components) box.size[*m_axes.components] = m_chosen->dims[*m_axes.components];
    auto left = static_cast<std::int64_t>(step);
    for (std::size_t n = m_axes.steps.size(); n-- > 0;) {
        const std::size_t a = m_axes.steps[n];
        box.first[a] = left % m_chosen->dims[a];
        left /= m_chosen->dims[a];
    }
    return box;
}

ArrayBox ArrayVolume::boxOf(int step, const ReaderBox& part) const {
    ArrayBox box = boxOf(step);
    for (std::size_t n = 0; n < m_axes.places.size(); ++n) { // the last place of the file is x
        const std::size_t a = m_axes.places[m_axes.places.size() - 1 - n];
        const int axis = static_cast<int>(n);
        box.first[a] = part.region.lo[axis];
        box.size[a] = part.region.hi[axis] - part.region.lo[axis];
    }
    // As componentsAreApart() says of layout(), in which the slowest axis is the last one.
    const auto isFaster = [&](std::size_t place) { return place > *m_axes.components; };
    if (m_axes.components && std::ranges::all_of(m_axes.places, isFaster)) {
        box.first[*m_axes.components] = part.component;
        box.size[*m_axes.components] = 1;
    }
    return box;
}

std::uint64_t ArrayVolume::bytesIn(const std::vector<std::int64_t>& size) const {
    std::uint64_t bytes = bytesPerValue(m_packed.type);
    for (const std::int64_t n : size)
        if (__builtin_mul_overflow(bytes, static_cast<std::uint64_t>(n), &bytes)) return ~std::uint64_t{0} / 8;
    return bytes;
}

std::vector<std::int64_t> ArrayVolume::pieceSize(const ArrayBox& whole) const {
    std::vector<std::int64_t> size = m_file->blockSize(*m_chosen);
    // Where one entry is wanted, no more is read, though its block is unpacked.
    for (std::size_t a = 0; a < size.size(); ++a) size[a] = std::min(size[a], whole.size[a]);
    for (std::size_t a = size.size(); a-- > 0;) {
        const std::int64_t blocks = (whole.size[a] + size[a] - 1) / size[a];
        const auto fitting = static_cast<std::int64_t>(kPieceBytes / std::max<std::uint64_t>(bytesIn(size), 1));
        size[a] *= std::clamp<std::int64_t>(fitting, 1, blocks);
        if (size[a] < whole.size[a]) break;
    }
    return size;
}

ReaderLayout ArrayVolume::layout(int step) const {
    requireIndex("time step", step, steps(), m_path);
    ReaderLayout answer;
    FileLayout& layout = answer.layout;
    layout.type = m_packed.type;
    layout.scaling = m_packed.scaling;
    const ArrayBox box = boxOf(step);
    for (std::size_t a = box.size.size(); a-- > 0;) {
        const bool isPlace = std::ranges::find(m_axes.places, a) != m_axes.places.end();
        if (isPlace || a == m_axes.components) layout.axes.push_back({box.size[a], a == m_axes.components});
    }
    layout.spacing = m_axes.spacing;
    layout.origin = m_axes.origin;
    layout.lengthUnit = m_axes.lengthUnit;
    layout.directions = m_axes.directions;
    layout.array = printable(m_chosen->name);
    for (const std::string& notice : m_notices) layout.notices.push_back(printable(notice));
    answer.missing = missingAs(contentsOf(layout).type, m_packed);
    if (m_axes.places.size() > 2) {
        const std::int64_t block = m_file->blockSize(*m_chosen)[m_axes.places[m_axes.places.size() - 3]];
        answer.layersAtOnce = static_cast<int>(std::clamp<std::int64_t>(block, 1, contentsOf(layout).dims.z));
    }
    if (const auto plain = areMarked(m_packed) ? m_file->plainValues(*m_chosen, box) : std::nullopt) {
        answer.inFile = {plain->start};
        layout.bigEndian = plain->bigEndian;
    }
    return answer;
}

FileContents ArrayVolume::contents() const {
    FileContents contents = contentsOf(layout(0).layout);
    contents.steps = static_cast<int>(std::min<std::uint64_t>(steps(), std::numeric_limits<int>::max()));
    contents.times = m_axes.times;
    contents.timeUnit = printable(m_axes.timeUnit);
    for (const ArrayVariable* volume : m_volumes) {
        contents.arrays.push_back(printable(volume->name));
        contents.details.push_back(detailsOf(*volume));
    }
    return contents;
}

std::uint64_t ArrayVolume::largestImageBytes() const {
    return bytesIn(m_file->blockSize(*m_chosen)) + bytesIn(pieceSize(boxOf(0)));
}

void ArrayVolume::read(int step, const ReaderBox& box, std::span<std::byte> voxels, const BeforeFile& before,
                       const JobControl& job) const {
    const ArrayBox whole = boxOf(step, box);
    const std::size_t width = bytesPerValue(m_packed.type);
    PELLUCID_CHECK(voxels.size() == bytesIn(whole.size));
    const std::vector<std::int64_t> size = pieceSize(whole);
    std::vector<std::byte> values;
    std::size_t done = 0;
    ArrayBox piece = whole;
    for (std::size_t a = 0; a < size.size(); ++a)
        piece.size[a] = std::min(size[a] - piece.first[a] % size[a], whole.size[a]);
    do {
        before(largestImageBytes());
        values.resize(bytesIn(piece.size));
        m_file->read(*m_chosen, piece, values);
        markMissing(m_packed, values);
        place(values, piece, whole, width, voxels);
        done += values.size();
        job.throwIfStopped();
        job.report(static_cast<double>(done) / static_cast<double>(voxels.size()));
    } while (goOn(piece, whole, size));
}

} // namespace pellucid
