#include "foreign/arrays/hdf5_types.h"

namespace pellucid {

namespace {

/// Values of an attribute: those of more are passed over.
constexpr hssize_t kMostValues = 100'000;

hid_t memoryTypeOf(ValueType type) {
    switch (type) {
    case ValueType::U8:
        return H5T_NATIVE_UINT8;
    case ValueType::I8:
        return H5T_NATIVE_INT8;
    case ValueType::U16:
        return H5T_NATIVE_UINT16;
    case ValueType::I16:
        return H5T_NATIVE_INT16;
    case ValueType::U32:
        return H5T_NATIVE_UINT32;
    case ValueType::I32:
        return H5T_NATIVE_INT32;
    case ValueType::U64:
        return H5T_NATIVE_UINT64;
    case ValueType::I64:
        return H5T_NATIVE_INT64;
    case ValueType::F32:
        return H5T_NATIVE_FLOAT;
    case ValueType::F64:
        return H5T_NATIVE_DOUBLE;
    }
    return -1;
}

Hdf5Type numbersOf(ValueType type) { return {type, Hdf5Handle(H5Tcopy(memoryTypeOf(type))), nameOf(type)}; }
Hdf5Type noNumbers(const std::string& name) { return {{}, Hdf5Handle(), name}; }

Hdf5Type integersOf(const Hdf5Handle& type) {
    const bool isSigned = H5Tget_sign(type.id()) == H5T_SGN_2;
    const std::size_t bytes = H5Tget_size(type.id());
    if (bytes <= 1) return numbersOf(isSigned ? ValueType::I8 : ValueType::U8);
    if (bytes <= 2) return numbersOf(isSigned ? ValueType::I16 : ValueType::U16);
    if (bytes <= 4) return numbersOf(isSigned ? ValueType::I32 : ValueType::U32);
    if (bytes <= 8) return numbersOf(isSigned ? ValueType::I64 : ValueType::U64);
    return noNumbers("integers of " + std::to_string(8 * bytes) + " bits");
}

/// h5py writes bool as an enumeration FALSE, TRUE of 8 bits.
bool isBool(const Hdf5Handle& type) {
    if (H5Tget_size(type.id()) != 1 || H5Tget_nmembers(type.id()) != 2) return false;
    char* const first = H5Tget_member_name(type.id(), 0);
    const bool is = first != nullptr && std::string(first) == "FALSE";
    H5free_memory(first);
    return is;
}

/// Bits are not converted to numbers by libhdf5: they are handed over as they are.
Hdf5Type bitsOf(const Hdf5Handle& type) {
    switch (H5Tget_size(type.id())) {
    case 1:
        return {ValueType::U8, Hdf5Handle(H5Tcopy(H5T_NATIVE_B8)), "u8"};
    case 2:
        return {ValueType::U16, Hdf5Handle(H5Tcopy(H5T_NATIVE_B16)), "u16"};
    case 4:
        return {ValueType::U32, Hdf5Handle(H5Tcopy(H5T_NATIVE_B32)), "u32"};
    case 8:
        return {ValueType::U64, Hdf5Handle(H5Tcopy(H5T_NATIVE_B64)), "u64"};
    default:
        return noNumbers("bits");
    }
}

bool isComplex(const Hdf5Handle& type) {
    return H5Tget_nmembers(type.id()) == 2 && H5Tget_member_class(type.id(), 0) == H5T_FLOAT &&
           H5Tget_member_class(type.id(), 1) == H5T_FLOAT;
}

std::string textIn(const Hdf5Handle& attribute, const Hdf5Handle& type) {
    if (H5Tis_variable_str(type.id()) > 0) {
        const Hdf5Handle memory(H5Tcopy(type.id()));
        char* text = nullptr;
        if (H5Aread(attribute.id(), memory.id(), static_cast<void*>(&text)) < 0 || text == nullptr) return {};
        std::string copy(text);
        H5free_memory(text);
        return copy;
    }
    const std::size_t bytes = H5Tget_size(type.id());
    if (bytes == 0 || bytes > static_cast<std::size_t>(kMostValues)) return {};
    std::string text(bytes, '\0');
    if (H5Aread(attribute.id(), type.id(), text.data()) < 0) return {};
    text.resize(std::min(text.size(), text.find('\0')));
    return text;
}

} // namespace

Hdf5Type typeOf(const Hdf5Handle& inFile) {
    switch (H5Tget_class(inFile.id())) {
    case H5T_INTEGER:
        return integersOf(inFile);
    case H5T_FLOAT:
        return numbersOf(H5Tget_size(inFile.id()) <= 4 ? ValueType::F32 : ValueType::F64);
    case H5T_ENUM: {
        if (isBool(inFile)) return numbersOf(ValueType::U8);
        return integersOf(Hdf5Handle(H5Tget_super(inFile.id())));
    }
    case H5T_BITFIELD:
        return bitsOf(inFile);
    case H5T_STRING:
        return noNumbers("texts");
    case H5T_COMPOUND:
        return noNumbers(isComplex(inFile) ? "complex numbers" : "records of several members");
    case H5T_ARRAY:
        return noNumbers("arrays in each place");
    case H5T_VLEN:
        return noNumbers("lists");
    case H5T_REFERENCE:
        return noNumbers("references");
    default:
        return noNumbers("something else than numbers");
    }
}

std::optional<ArrayAttribute> hdf5Attribute(const Hdf5Handle& object, const std::string& name) {
    if (H5Aexists(object.id(), name.c_str()) <= 0) return {};
    const Hdf5Handle attribute(H5Aopen(object.id(), name.c_str(), H5P_DEFAULT));
    if (!attribute) return {};
    const Hdf5Handle inFile(H5Aget_type(attribute.id())), space(H5Aget_space(attribute.id()));
    const hssize_t count = H5Sget_simple_extent_npoints(space.id());
    if (count < 1 || count > kMostValues) return {};
    ArrayAttribute read;
    if (H5Tget_class(inFile.id()) == H5T_STRING) {
        if (count == 1) read.text = textIn(attribute, inFile);
        return read;
    }
    const Hdf5Type type = typeOf(inFile);
    if (!type.kept) return {};
    read.areFloats = *type.kept == ValueType::F32 || *type.kept == ValueType::F64;
    read.numbers = withType(*type.kept, [&](auto zero) {
        std::vector<decltype(zero)> values(static_cast<std::size_t>(count));
        if (H5Aread(attribute.id(), type.inMemory.id(), values.data()) < 0) values.clear();
        return std::vector<double>(values.begin(), values.end());
    });
    return read;
}

} // namespace pellucid
