// HDF5, and what is HDF5 underneath: NetCDF-4 and MATLAB's files of version 7.3. By libhdf5, without its plugins.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <set>

#include "base/text.h"
#include "foreign/arrays/array_file.h"
#include "foreign/arrays/hdf5_types.h"
#include "volume/formats/file_check.h"

namespace pellucid {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostObjects = 100'000;
constexpr int kMostDepth = 64; ///< of groups in groups
constexpr const char* kCopyAgain = "the file is damaged: copy it again";
constexpr const char* kRepack = "write it anew with h5repack -f GZIP=4, or by a program that has this";

/// What the numbers of filters mean that libhdf5 has not (registered at The HDF Group).
std::string nameOfFilter(H5Z_filter_t filter, const std::string& own) {
    static constexpr std::pair<int, const char*> kNames[] = {
        {305, "LZO"},      {307, "bzip2"},       {4, "szip"},           {32000, "LZF"},       {32001, "Blosc"},
        {32002, "MAFISC"}, {32004, "LZ4"},       {32008, "bitshuffle"}, {32010, "PNG"},       {32012, "JPEG"},
        {32013, "ZFP"},    {32015, "Zstandard"}, {32017, "SZ"},         {32019, "FCIDECOMP"}, {32026, "Blosc2"}};
    for (const auto& [number, name] : kNames)
        if (filter == number) return name;
    return own.empty() ? "filter " + std::to_string(filter) : printable(own);
}

std::string toText(const char* text) { return text == nullptr ? "" : text; }

/// Values along one axis, or more, as libhdf5 counts them.
using Sizes = std::vector<hsize_t>;

Sizes sizesOf(const std::vector<std::int64_t>& sizes) { return {sizes.begin(), sizes.end()}; }

std::uint64_t productOf(const Sizes& sizes) {
    std::uint64_t product = 1;
    for (const hsize_t size : sizes)
        if (__builtin_mul_overflow(product, size, &product)) return ~std::uint64_t{0};
    return product;
}

/// What a stored byte may become at most; empty where that is not known.
std::optional<std::uint64_t> mostOfOneByte(const Hdf5Handle& how) {
    constexpr std::uint64_t kOfDeflate = 1040; // a match of 258 bytes costs at least two bits
    std::uint64_t most = 1;
    const int count = H5Pget_nfilters(how.id());
    for (int n = 0; n < count; ++n) {
        unsigned flags = 0, config = 0;
        std::size_t values = 0;
        switch (H5Pget_filter2(how.id(), static_cast<unsigned>(n), &flags, &values, nullptr, 0, nullptr, &config)) {
        case H5Z_FILTER_SHUFFLE:
        case H5Z_FILTER_FLETCHER32:
            break;
        case H5Z_FILTER_DEFLATE:
            most *= kOfDeflate;
            break;
        default:
            return {};
        }
        if (most > kOfDeflate * kOfDeflate) return {};
    }
    return most;
}

class Hdf5File final : public ArrayFile {
public:
    explicit Hdf5File(const std::string& path) : m_path(path) {
        m_file = Hdf5Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
        if (!m_file) fail("HDF5 cannot open it");
        const Hdf5Handle root(H5Gopen2(m_file.id(), "/", H5P_DEFAULT));
        if (!root) fail("HDF5 cannot open it");
        const std::string suffix = lowerCase(fs::path(path).extension().string());
        m_isNetCdf = H5Aexists(root.id(), "_NCProperties") > 0 || suffix == ".nc" || suffix == ".nc4";
        look(root, "", 0);
        std::ranges::sort(m_variables, {}, &ArrayVariable::name);
    }

    bool isNetCdf() const override { return m_isNetCdf; }
    const std::vector<ArrayVariable>& variables() const override { return m_variables; }
    std::vector<std::string> files() const override {
        std::vector<std::string> files{m_path};
        files.insert(files.end(), m_others.begin(), m_others.end());
        return files;
    }
    std::vector<std::string> notices() const override { return m_notices; }

    std::optional<ArrayAttribute> attribute(const ArrayVariable& variable, const std::string& name) const override {
        return hdf5Attribute(open(variable), name);
    }

    std::vector<ArrayDimension> dimensions(const ArrayVariable& variable) const override;
    std::vector<std::string> check(const ArrayVariable& variable) const override;
    std::vector<std::int64_t> blockSize(const ArrayVariable& variable) const override {
        std::vector<std::int64_t> size(variable.dims.size(), 1);
        const Hdf5Handle how(H5Dget_create_plist(open(variable).id()));
        if (H5Pget_layout(how.id()) != H5D_CHUNKED) return size;
        const Sizes chunk = chunkOf(how, variable);
        for (std::size_t a = 0; a < size.size(); ++a) size[a] = static_cast<std::int64_t>(chunk[a]);
        return size;
    }

    std::optional<PlainValues> plainValues(const ArrayVariable& variable, const ArrayBox& box) const override;
    void read(const ArrayVariable& variable, const ArrayBox& box, std::span<std::byte> to) const override {
        const Hdf5Handle& data = open(variable);
        const Hdf5Handle inFile(H5Dget_type(data.id())), there(H5Dget_space(data.id()));
        const Hdf5Type type = typeOf(inFile);
        const Sizes first = sizesOf(box.first), size = sizesOf(box.size);
        const Hdf5Handle here(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr));
        const bool isSelected =
            H5Sselect_hyperslab(there.id(), H5S_SELECT_SET, first.data(), nullptr, size.data(), nullptr) >= 0;
        if (!isSelected || H5Dread(data.id(), type.inMemory.id(), here.id(), there.id(), H5P_DEFAULT, to.data()) < 0)
            fail("HDF5 cannot read " + inQuotes(variable.name));
    }

private:
    [[noreturn]] void fail(const std::string& what) const {
        const std::string why = hdf5Problem();
        throw FileError(what + (why.empty() ? "" : " (" + why + ")"), m_path, kCopyAgain);
    }

    /// All arrays in a group, and in those below.
    void look(const Hdf5Handle& group, const std::string& name, int depth);
    void lookAt(const Hdf5Handle& group, const std::string& link, const std::string& name, int depth);
    void follow(const Hdf5Handle& group, const std::string& link, const std::string& name);
    void add(const Hdf5Handle& data, const std::string& name);
    /// Whether a file that this one names may be read: it lies in the same folder, or below.
    bool isNear(const std::string& file) const {
        const fs::path other(file);
        const fs::path folder = fs::absolute(folderToRead(m_path)).lexically_normal();
        const fs::path all = (other.is_absolute() ? other : folder / other).lexically_normal();
        const fs::path within = all.lexically_relative(folder);
        return !within.empty() && *within.begin() != "..";
    }

    const Hdf5Handle& open(const ArrayVariable& variable) const {
        if (m_opened != variable.name || !m_data) {
            const Hdf5Handle access(H5Pcreate(H5P_DATASET_ACCESS));
            H5Pset_efile_prefix(access.id(), "${ORIGIN}");
            H5Pset_virtual_prefix(access.id(), "${ORIGIN}");
            m_data = Hdf5Handle(H5Dopen2(m_file.id(), variable.name.c_str(), access.id()));
            if (!m_data) fail("HDF5 cannot open " + inQuotes(variable.name));
            m_opened = variable.name;
        }
        return m_data;
    }

    /// Bytes before what libhdf5 has written.
    hsize_t userBlock() const {
        const Hdf5Handle how(H5Fget_create_plist(m_file.id()));
        hsize_t bytes = 0;
        return H5Pget_userblock(how.id(), &bytes) < 0 ? ~hsize_t{0} : bytes;
    }

    static Sizes chunkOf(const Hdf5Handle& how, const ArrayVariable& variable) {
        Sizes chunk(variable.dims.size(), 1);
        H5Pget_chunk(how.id(), static_cast<int>(chunk.size()), chunk.data());
        std::ranges::replace(chunk, hsize_t{0}, hsize_t{1});
        return chunk;
    }

    void requireFilters(const Hdf5Handle& how, const ArrayVariable& variable) const;
    void requireOtherFiles(const Hdf5Handle& how, const ArrayVariable& variable) const;
    std::vector<std::string> checkSources(const Hdf5Handle& how, const ArrayVariable& variable) const;
    std::vector<std::string> checkChunks(const Hdf5Handle& data, const Hdf5Handle& how,
                                         const ArrayVariable& variable) const;

    const std::string m_path;
    Hdf5Handle m_file;
    bool m_isNetCdf = false;
    std::vector<ArrayVariable> m_variables;
    std::set<std::pair<unsigned long, haddr_t>> m_seen; ///< objects, since groups may lead back
    std::set<std::string> m_others;                     ///< files that links lead to
    std::vector<std::string> m_notices;
    mutable Hdf5Handle m_data; ///< the array that was looked at last
    mutable std::string m_opened;
};

void Hdf5File::look(const Hdf5Handle& group, const std::string& name, int depth) {
    std::vector<std::string> links;
    hsize_t at = 0;
    const auto note = [](hid_t, const char* link, const H5L_info_t*, void* to) -> herr_t {
        auto& all = *static_cast<std::vector<std::string>*>(to);
        all.emplace_back(link);
        return all.size() < kMostObjects ? 0 : 1;
    };
    if (H5Literate(group.id(), H5_INDEX_NAME, H5_ITER_INC, &at, note, &links) < 0)
        m_notices.push_back("the group " + inQuotes(name + "/") + " cannot be read: " + hdf5Problem());
    for (const std::string& link : links) lookAt(group, link, name + "/" + link, depth);
}

void Hdf5File::lookAt(const Hdf5Handle& group, const std::string& link, const std::string& name, int depth) {
    if (m_seen.size() >= kMostObjects || depth > kMostDepth) return;
    H5L_info_t info{};
    if (H5Lget_info(group.id(), link.c_str(), &info, H5P_DEFAULT) < 0) return;
    if (info.type == H5L_TYPE_EXTERNAL) return follow(group, link, name);
    if (info.type != H5L_TYPE_HARD) return; // what it leads to has a name of its own
    const Hdf5Handle object(H5Oopen(group.id(), link.c_str(), H5P_DEFAULT));
    if (!object) {
        m_notices.push_back(inQuotes(name) + " cannot be read: " + hdf5Problem());
        return;
    }
    H5O_info_t about{};
    if (H5Oget_info2(object.id(), &about, H5O_INFO_BASIC) < 0) return;
    if (!m_seen.emplace(about.fileno, about.addr).second) return;
    if (about.type == H5O_TYPE_GROUP) look(object, name, depth + 1);
    if (about.type == H5O_TYPE_DATASET) add(object, name);
}

/// A link into another file.
void Hdf5File::follow(const Hdf5Handle& group, const std::string& link, const std::string& name) {
    H5L_info_t info{};
    H5Lget_info(group.id(), link.c_str(), &info, H5P_DEFAULT);
    std::vector<char> value(info.u.val_size);
    const char *file = nullptr, *object = nullptr;
    if (value.empty() || H5Lget_val(group.id(), link.c_str(), value.data(), value.size(), H5P_DEFAULT) < 0 ||
        H5Lunpack_elink_val(value.data(), value.size(), nullptr, &file, &object) < 0)
        return;
    const std::string other = toText(file);
    if (!isNear(other)) {
        m_notices.push_back("the link " + inQuotes(name) + " is not followed: it leads to " + inQuotes(other) +
                            ", which is outside this folder");
        return;
    }
    const Hdf5Handle found(H5Oopen(group.id(), link.c_str(), H5P_DEFAULT));
    if (!found) {
        m_notices.push_back("the link " + inQuotes(name) + " leads to " + inQuotes(other) +
                            ", where there is nothing that can be read");
        return;
    }
    m_others.insert((fs::path(folderToRead(m_path)) / other).string());
    if (H5Iget_type(found.id()) == H5I_DATASET) add(found, name);
}

void Hdf5File::add(const Hdf5Handle& data, const std::string& name) {
    const Hdf5Handle space(H5Dget_space(data.id())), inFile(H5Dget_type(data.id()));
    const int axes = H5Sget_simple_extent_ndims(space.id());
    if (axes < 1 || !inFile) return;
    Sizes sizes(static_cast<std::size_t>(axes));
    H5Sget_simple_extent_dims(space.id(), sizes.data(), nullptr);
    const Hdf5Type type = typeOf(inFile);
    ArrayVariable variable{name, {}, type.kept, type.name};
    for (const hsize_t size : sizes)
        variable.dims.push_back(static_cast<std::int64_t>(std::min<hsize_t>(size, INT64_MAX)));
    m_variables.push_back(std::move(variable));
}

/// By the dimension scales that are attached ("HDF5 Dimension Scale Specification"): DIMENSION_LIST has references to
/// them for each axis. NetCDF-4 keeps its dimensions so.
std::vector<ArrayDimension> Hdf5File::dimensions(const ArrayVariable& variable) const {
    std::vector<ArrayDimension> all(variable.dims.size());
    const Hdf5Handle& data = open(variable);
    if (H5Aexists(data.id(), "DIMENSION_LIST") <= 0) return all;
    const Hdf5Handle attribute(H5Aopen(data.id(), "DIMENSION_LIST", H5P_DEFAULT));
    const Hdf5Handle inFile(H5Aget_type(attribute.id())), space(H5Aget_space(attribute.id()));
    const Hdf5Handle inMemory(H5Tvlen_create(H5T_STD_REF_OBJ));
    if (H5Tget_class(inFile.id()) != H5T_VLEN ||
        H5Sget_simple_extent_npoints(space.id()) != static_cast<hssize_t>(all.size()))
        return all;
    std::vector<hvl_t> lists(all.size());
    if (H5Aread(attribute.id(), inMemory.id(), lists.data()) < 0) return all;
    for (std::size_t a = 0; a < all.size(); ++a) {
        if (lists[a].len == 0) continue;
        const Hdf5Handle scale(H5Rdereference2(data.id(), H5P_DEFAULT, H5R_OBJECT, lists[a].p));
        if (!scale || H5Iget_type(scale.id()) != H5I_DATASET) continue;
        std::array<char, 1024> name{};
        if (H5Iget_name(scale.id(), name.data(), name.size()) <= 0) continue;
        all[a].name = fs::path(name.data()).filename().string();
        // NetCDF-4 marks dimensions without coordinates by this.
        const auto label = hdf5Attribute(scale, "NAME");
        const bool isBare = label && label->text.starts_with("This is a netCDF dimension but not a netCDF variable");
        const ArrayVariable* const found = isBare ? nullptr : find(name.data());
        if (found != nullptr && found->type && found->dims.size() == 1) all[a].coordinates = found->name;
    }
    H5Dvlen_reclaim(inMemory.id(), space.id(), H5P_DEFAULT, lists.data());
    return all;
}

std::vector<std::string> Hdf5File::check(const ArrayVariable& variable) const {
    const Hdf5Handle& data = open(variable);
    const Hdf5Handle how(H5Dget_create_plist(data.id()));
    requireFilters(how, variable);
    requireOtherFiles(how, variable);
    switch (H5Pget_layout(how.id())) {
    case H5D_VIRTUAL:
        return checkSources(how, variable);
    case H5D_CHUNKED:
        return checkChunks(data, how, variable);
    default:
        break;
    }
    if (H5Dget_storage_size(data.id()) == 0)
        return {"no value of " + inQuotes(variable.name) +
                " is in the file: all are what stands for values not written"};
    return {};
}

/// Of arrays in one piece, of numbers as processors have them.
std::optional<PlainValues> Hdf5File::plainValues(const ArrayVariable& variable, const ArrayBox& box) const {
    const Hdf5Handle& data = open(variable);
    const Hdf5Handle how(H5Dget_create_plist(data.id())), inFile(H5Dget_type(data.id()));
    const bool isHere = H5Pget_layout(how.id()) == H5D_CONTIGUOUS && H5Pget_external_count(how.id()) == 0 &&
                        m_others.empty() && userBlock() == 0;
    if (!isHere || !isRun(variable, box)) return {};
    const Hdf5Type type = typeOf(inFile);
    const H5T_order_t order = H5Tget_order(inFile.id());
    const Hdf5Handle same(H5Tcopy(type.inMemory.id()));
    if ((order != H5T_ORDER_LE && order != H5T_ORDER_BE) || H5Tset_order(same.id(), order) < 0 ||
        H5Tequal(same.id(), inFile.id()) <= 0)
        return {};
    const std::uint64_t width = H5Tget_size(inFile.id()), all = valuesIn(variable) * width;
    const haddr_t start = H5Dget_offset(data.id());
    const std::uint64_t there = readableFileBytes(m_path);
    if (start == HADDR_UNDEF || H5Dget_storage_size(data.id()) != all || start > there || all > there - start)
        return {};
    std::uint64_t at = 0;
    for (std::size_t a = 0; a < variable.dims.size(); ++a)
        at = at * static_cast<std::uint64_t>(variable.dims[a]) + static_cast<std::uint64_t>(box.first[a]);
    return PlainValues{start + at * width, order == H5T_ORDER_BE};
}

void Hdf5File::requireFilters(const Hdf5Handle& how, const ArrayVariable& variable) const {
    const int count = H5Pget_nfilters(how.id());
    for (int n = 0; n < count; ++n) {
        unsigned flags = 0, config = 0;
        std::size_t values = 0;
        std::array<char, 200> name{};
        const H5Z_filter_t filter = H5Pget_filter2(how.id(), static_cast<unsigned>(n), &flags, &values, nullptr,
                                                   name.size() - 1, name.data(), &config);
        if (H5Zfilter_avail(filter) <= 0)
            throw FileError(inQuotes(variable.name) + " is packed by " + nameOfFilter(filter, name.data()) +
                                ", which is not supported",
                            m_path, kRepack);
    }
}

/// Raw data in other files.
void Hdf5File::requireOtherFiles(const Hdf5Handle& how, const ArrayVariable& variable) const {
    const int count = H5Pget_external_count(how.id());
    for (int n = 0; n < count; ++n) {
        std::array<char, 4096> name{};
        off_t offset = 0;
        hsize_t bytes = 0;
        if (H5Pget_external(how.id(), static_cast<unsigned>(n), name.size() - 1, name.data(), &offset, &bytes) < 0)
            fail("HDF5 cannot open " + inQuotes(variable.name));
        if (!isNear(name.data()))
            throw FileError("the values of " + inQuotes(variable.name) + " are in the file " + inQuotes(name.data()) +
                                ", which is outside this folder",
                            m_path, "copy that file into this folder, and write this one anew");
        const fs::path other = fs::path(folderToRead(m_path)) / name.data();
        std::error_code ec;
        const auto there = fs::file_size(other, ec);
        if (ec || (bytes != H5F_UNLIMITED && there < static_cast<std::uint64_t>(offset) + bytes))
            throw FileError("the values of " + inQuotes(variable.name) + " are in the file " + inQuotes(name.data()) +
                                (ec ? ", which is not there" : ", which is too short"),
                            m_path, "copy that file again");
    }
}

/// A virtual array is put together from others; libhdf5 says nothing where they are missing.
std::vector<std::string> Hdf5File::checkSources(const Hdf5Handle& how, const ArrayVariable& variable) const {
    std::size_t count = 0;
    if (H5Pget_virtual_count(how.id(), &count) < 0) fail("HDF5 cannot open " + inQuotes(variable.name));
    std::set<std::pair<std::string, std::string>> seen;
    std::uint64_t filled = 0;
    for (std::size_t n = 0; n < count; ++n) {
        const Hdf5Handle part(H5Pget_virtual_vspace(how.id(), n));
        const hssize_t points = H5Sget_select_npoints(part.id());
        filled += points < 0 ? valuesIn(variable) : static_cast<std::uint64_t>(points); // below 0: without end
        std::array<char, 4096> file{}, array{};
        H5Pget_virtual_filename(how.id(), n, file.data(), file.size());
        H5Pget_virtual_dsetname(how.id(), n, array.data(), array.size());
        if (!seen.emplace(file.data(), array.data()).second) continue;
        const auto refuse = [&](const std::string& why, const char* toDo) {
            throw FileError("the values of " + inQuotes(variable.name) + " are in the file " + inQuotes(file.data()) +
                                ", " + why,
                            m_path, toDo);
        };
        const bool isHere = std::strcmp(file.data(), ".") == 0;
        if (!isHere && !isNear(file.data()))
            refuse("which is outside this folder", "copy that file into this folder, and write this one anew");
        const std::string path = isHere ? m_path : (fs::path(folderToRead(m_path)) / file.data()).string();
        const Hdf5Handle other(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
        if (!other) refuse("which cannot be read", "copy that file into this folder");
        const Hdf5Handle source(H5Dopen2(other.id(), array.data(), H5P_DEFAULT));
        if (!source) refuse("which has no array " + inQuotes(array.data()), "copy that file again");
        requireFilters(Hdf5Handle(H5Dget_create_plist(source.id())), variable);
    }
    const std::uint64_t all = valuesIn(variable);
    if (filled >= all) return {};
    return {std::to_string(all - filled) + " of " + std::to_string(all) + " values of " + inQuotes(variable.name) +
            " are in no file: they have what stands for values not written"};
}

/// What is stored can hold a chunk, before one is allocated.
std::vector<std::string> Hdf5File::checkChunks(const Hdf5Handle& data, const Hdf5Handle& how,
                                               const ArrayVariable& variable) const {
    const Sizes chunk = chunkOf(how, variable);
    const Hdf5Handle inFile(H5Dget_type(data.id())), space(H5Dget_space(data.id()));
    const std::uint64_t stored = H5Dget_storage_size(data.id());
    const std::uint64_t count = productOf(chunk), width = H5Tget_size(inFile.id());
    const std::uint64_t bytes =
        count > ~std::uint64_t{0} / std::max<std::uint64_t>(width, 1) ? ~std::uint64_t{0} : count * width;
    if (const auto most = mostOfOneByte(how); stored > 0 && most && bytes / *most > stored)
        throw FileError("the header of " + inQuotes(variable.name) + " claims blocks of " + describeBytes(bytes) +
                            ", but " + describeBytes(stored) + " are stored",
                        m_path, kCopyAgain);
    hsize_t chunks = 0;
    if (H5Dget_num_chunks(data.id(), space.id(), &chunks) < 0) fail("HDF5 cannot read " + inQuotes(variable.name));
    Sizes blocks;
    for (std::size_t a = 0; a < chunk.size(); ++a)
        blocks.push_back((static_cast<hsize_t>(variable.dims[a]) + chunk[a] - 1) / chunk[a]);
    const std::uint64_t all = productOf(blocks);
    if (chunks >= all) return {};
    return {std::to_string(all - chunks) + " of " + std::to_string(all) + " blocks of " + inQuotes(variable.name) +
            " are not in the file: they have what stands for values not written"};
}

/// Once: no plugins, no locks (which file systems of clusters may not have), no words on the standard error.
void prepareLibrary() {
    setenv("HDF5_USE_FILE_LOCKING", "FALSE", 1);
    H5dont_atexit();
    H5open();
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    H5PLset_loading_state(0);
}

} // namespace

std::string hdf5Problem() {
    std::string problem;
    const auto first = [](unsigned n, const H5E_error2_t* error, void* to) -> herr_t {
        if (n == 0) *static_cast<std::string*>(to) = toText(error->desc);
        return 0;
    };
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, first, &problem);
    return printable(problem);
}

std::unique_ptr<ArrayFile> openHdf5(const std::string& path, const BeforeFile& before) {
    before(bytesOfFile(path));
    prepareLibrary();
    return std::make_unique<Hdf5File>(path);
}

} // namespace pellucid
