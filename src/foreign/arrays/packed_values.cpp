#include "foreign/arrays/packed_values.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text.h"

namespace pellucid {

namespace {

bool isFloat(ValueType type) { return type == ValueType::F32 || type == ValueType::F64; }

/// `_Unsigned`: types of NetCDF-3 are signed, whatever is meant.
ValueType meantType(const ArrayFile& file, const ArrayVariable& variable) {
    const ValueType type = variable.type.value();
    const std::string text = lowerCase(file.text(variable, "_Unsigned"));
    const bool unsignedMeant = text == "true", signedMeant = text == "false";
    switch (type) {
    case ValueType::I8:
        return unsignedMeant ? ValueType::U8 : type;
    case ValueType::I16:
        return unsignedMeant ? ValueType::U16 : type;
    case ValueType::I32:
        return unsignedMeant ? ValueType::U32 : type;
    case ValueType::I64:
        return unsignedMeant ? ValueType::U64 : type;
    case ValueType::U8:
        return signedMeant ? ValueType::I8 : type;
    default:
        return type;
    }
}

/// What libraries write where nothing is written (netcdf.h, NC_FILL_…); bytes have none, since each may be meant.
std::optional<double> usualFill(ValueType type) {
    switch (type) {
    case ValueType::I16:
        return -32767;
    case ValueType::U16:
        return 65535;
    case ValueType::I32:
        return -2147483647;
    case ValueType::U32:
        return 4294967295;
    case ValueType::I64:
        return -9223372036854775806.0;
    case ValueType::U64:
        return 18446744073709551614.0;
    case ValueType::F32:
    case ValueType::F64:
        return 9.9692099683868690e+36;
    default:
        return {};
    }
}

/// A number of an attribute in the meant type: −1 may stand for 255; floats are as exact as the values.
double asMeant(double number, ValueType type) {
    return withType(type, [&](auto zero) -> double {
        using T = decltype(zero);
        if constexpr (std::is_same_v<T, float>) return static_cast<double>(static_cast<float>(number));
        if constexpr (std::is_unsigned_v<T>) return number < 0 ? number + std::ldexp(1.0, 8 * sizeof(T)) : number;
        if constexpr (std::is_same_v<T, std::int8_t>) return number > 127 ? number - 256 : number;
        return number;
    });
}

std::optional<ValueScaling> scalingOf(const ArrayFile& file, const ArrayVariable& variable,
                                      std::vector<std::string>& notices) {
    const ValueScaling scaling{file.number(variable, "scale_factor").value_or(1),
                               file.number(variable, "add_offset").value_or(0)};
    if (scaling.slope == 1 && scaling.intercept == 0) return {};
    if (std::isfinite(scaling.slope) && std::isfinite(scaling.intercept) && scaling.slope != 0) return scaling;
    notices.emplace_back("scale_factor and add_offset cannot be meant, and are passed over");
    return {};
}

ValueRange wholeRange(ValueType type) {
    return withType(type, [](auto zero) {
        using T = std::numeric_limits<decltype(zero)>;
        return ValueRange{static_cast<double>(T::lowest()), static_cast<double>(T::max())};
    });
}

/// Limits are in the packed type, unless they have the type of what is meant.
std::optional<ValueRange> validRange(const ArrayFile& file, const ArrayVariable& variable, const PackedValues& packed) {
    const auto range = file.attribute(variable, "valid_range");
    const auto low = range ? range : file.attribute(variable, "valid_min");
    const auto high = range ? range : file.attribute(variable, "valid_max");
    const bool hasLow = low && !low->numbers.empty(), hasHigh = high && !high->numbers.empty();
    if (!hasLow && !hasHigh) return {};
    const auto stored = [&](const ArrayAttribute& limit, double number) {
        if (!packed.scaling || !limit.areFloats || isFloat(packed.type)) return asMeant(number, packed.type);
        return (number - packed.scaling->intercept) / packed.scaling->slope;
    };
    ValueRange valid = wholeRange(packed.type);
    if (hasLow) valid.lo = stored(*low, low->numbers.front());
    if (hasHigh) valid.hi = stored(*high, high->numbers.back());
    if (valid.lo > valid.hi) std::swap(valid.lo, valid.hi); // turned round by a slope below 0
    return valid;
}

/// A whole number outside of `valid`; empty where all are in it.
std::optional<double> numberOutside(const ValueRange& valid, ValueType type) {
    const ValueRange whole = wholeRange(type);
    if (whole.lo < valid.lo) return whole.lo;
    if (whole.hi > valid.hi) return whole.hi;
    return {};
}

} // namespace

PackedValues packedValuesOf(const ArrayFile& file, const ArrayVariable& variable) {
    PackedValues packed;
    packed.type = meantType(file, variable);
    packed.scaling = scalingOf(file, variable, packed.notices);
    for (const char* name : {"_FillValue", "missing_value"})
        if (const auto attribute = file.attribute(variable, name))
            for (const double number : attribute->numbers) packed.missing.push_back(asMeant(number, packed.type));
    const bool hasFill = file.attribute(variable, "_FillValue").has_value();
    if (const auto usual = usualFill(packed.type); usual && file.isNetCdf() && !hasFill)
        packed.missing.push_back(asMeant(*usual, packed.type));
    packed.valid = validRange(file, variable, packed);
    if (isFloat(packed.type)) return packed;           // NaN stands for none
    std::erase_if(packed.missing, [&](double number) { // no value is so
        const ValueRange whole = wholeRange(packed.type);
        return !(number >= whole.lo && number <= whole.hi) || number != std::floor(number);
    });
    if (!packed.missing.empty())
        packed.mark = packed.missing.front();
    else if (packed.valid)
        packed.mark = numberOutside(*packed.valid, packed.type);
    return packed;
}

void markMissing(const PackedValues& packed, std::span<std::byte> values) {
    if (areMarked(packed)) return;
    withType(packed.type, [&](auto zero) {
        using T = decltype(zero);
        const std::span<T> all(reinterpret_cast<T*>(values.data()), values.size() / sizeof(T));
        T mark{};
        if constexpr (std::is_floating_point_v<T>)
            mark = std::numeric_limits<T>::quiet_NaN();
        else if (packed.mark)
            mark = *packed.mark >= std::ldexp(1.0, 63) ? static_cast<T>(static_cast<std::uint64_t>(*packed.mark))
                                                       : static_cast<T>(static_cast<std::int64_t>(*packed.mark));
        for (T& value : all) {
            const auto number = static_cast<double>(value);
            const bool isNone = (packed.valid && !(number >= packed.valid->lo && number <= packed.valid->hi)) ||
                                std::ranges::find(packed.missing, number) != packed.missing.end();
            if (isNone) value = mark;
        }
    });
}

bool areMarked(const PackedValues& packed) {
    return !packed.valid && std::ranges::all_of(packed.missing, [&](double value) { return packed.mark == value; });
}

std::optional<double> missingAs(SampleType kept, const PackedValues& packed) {
    if (!packed.mark) return {};
    if (!packed.scaling) return packed.mark;
    const double value = packed.scaling->slope * *packed.mark + packed.scaling->intercept;
    return kept == SampleType::F32 ? static_cast<double>(static_cast<float>(value)) : value;
}

} // namespace pellucid
