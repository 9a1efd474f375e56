// Vectors of eight: the arithmetic in which the sweep is written, on eight rays, eight voxels or eight transfer
// functions at once. Serves all of docs/method.md, "The cpu engine"; nothing here knows of volumes.
//
// The vectors are the compiler's own: + − * / < work element by element, a comparison gives −1 where it holds and 0
// elsewhere, and `mask ? a : b` picks by element. Only what has no operator is a function below. Everything is in an
// unnamed namespace and uses no templates of the standard library: two .cpp compile it for different processors, and no
// code for the newer one may leak into the rest of the program.
#pragma once

#ifdef __AVX2__
#include <immintrin.h>
#endif

#include "render/cpu/sweep.h"

namespace pellucid {
namespace {

// ---- Types, loads and stores ------------------------------------------------------------------------------

typedef float Vec8 __attribute__((vector_size(32)));
typedef int Int8 __attribute__((vector_size(32)));
typedef std::uint16_t UShort8 __attribute__((vector_size(16)));
typedef std::uint8_t UChar8 __attribute__((vector_size(8)));

// The same in memory: at any element, and whatever type was stored there.
typedef float Vec8InMemory __attribute__((vector_size(32), aligned(4), may_alias));
typedef int Int8InMemory __attribute__((vector_size(32), aligned(4), may_alias));
typedef std::uint16_t UShort8InMemory __attribute__((vector_size(16), aligned(2), may_alias));
typedef std::uint8_t UChar8InMemory __attribute__((vector_size(8), aligned(1), may_alias));

constexpr int kWide = 8;            ///< rays, voxels or transfer functions in one vector
static_assert(kWide == kBlockSize); // a vector of voxels lies in one block of the opaque map
constexpr Vec8 kIota = {0, 1, 2, 3, 4, 5, 6, 7};

inline Vec8 load(const float* p) { return *reinterpret_cast<const Vec8InMemory*>(p); }
inline Int8 load(const int* p) { return *reinterpret_cast<const Int8InMemory*>(p); }
inline UShort8 load(const std::uint16_t* p) { return *reinterpret_cast<const UShort8InMemory*>(p); }
inline UChar8 load(const std::uint8_t* p) { return *reinterpret_cast<const UChar8InMemory*>(p); }
inline void store(std::uint16_t* p, UShort8 v) { *reinterpret_cast<UShort8InMemory*>(p) = v; }
inline void store(float* p, Vec8 v) { *reinterpret_cast<Vec8InMemory*>(p) = v; }
inline void store(int* p, Int8 v) { *reinterpret_cast<Int8InMemory*>(p) = v; }

inline Vec8 toFloat(Int8 v) { return __builtin_convertvector(v, Vec8); }
inline Vec8 toFloat(UShort8 v) { return __builtin_convertvector(__builtin_convertvector(v, Int8), Vec8); }
inline Int8 toInt(Vec8 v) { return __builtin_convertvector(v, Int8); } ///< towards 0
inline Int8 asInts(const std::uint16_t* p) { return __builtin_convertvector(load(p), Int8); }
inline Int8 asInts(const std::uint8_t* p) { return __builtin_convertvector(load(p), Int8); }
inline Vec8 asFloats(const std::uint16_t* p) { return toFloat(load(p)); }
inline Vec8 asFloats(const std::uint8_t* p) { return toFloat(asInts(p)); }
inline Vec8 asFloats(const float* p) { return load(p); }
inline UShort8 asCodes(const std::uint16_t* p) { return load(p); }
inline UShort8 asCodes(const std::uint8_t* p) { return __builtin_convertvector(load(p), UShort8); }

// ---- Reading from scattered places ------------------------------------------------------------------------

/// from[x[0]], …, from[x[7]].
inline Int8 gathered(const int* from, Int8 x) {
#ifdef __AVX2__
    return reinterpret_cast<Int8>(_mm256_i32gather_epi32(from, reinterpret_cast<__m256i>(x), 4));
#else
    return Int8{from[x[0]], from[x[1]], from[x[2]], from[x[3]], from[x[4]], from[x[5]], from[x[6]], from[x[7]]};
#endif
}

/// from[x] and from[x + 1] for each x; x ascends, and sixteen may be read from x[0] on.
template <class T>
inline void pairsAt(const T* from, Int8 x, Vec8& near, Vec8& far) {
#ifdef __AVX2__
    if (x[kWide - 1] - x[0] < 2 * kWide - 1) { // sixteen neighbours hold them all: cheaper than gathering
        const Vec8 low = asFloats(from + x[0]), high = asFloats(from + x[0] + kWide);
        const auto pick = [&](Int8 index) {
            const __m256i i = reinterpret_cast<__m256i>(index);
            const Vec8 fromLow = reinterpret_cast<Vec8>(_mm256_permutevar8x32_ps(reinterpret_cast<__m256>(low), i)),
                       fromHigh = reinterpret_cast<Vec8>(_mm256_permutevar8x32_ps(reinterpret_cast<__m256>(high), i));
            return index < kWide ? fromLow : fromHigh;
        };
        const Int8 index = x - x[0];
        near = pick(index);
        far = pick(index + 1);
        return;
    }
#endif
    for (int n = 0; n < kWide; ++n) {
        near[n] = static_cast<float>(from[x[n]]);
        far[n] = static_cast<float>(from[x[n] + 1]);
    }
}

// ---- Masks, as comparisons give them ----------------------------------------------------------------------

/// True where no bit is set.
inline bool none(Int8 v) {
#ifdef __AVX2__
    return _mm256_testz_si256(reinterpret_cast<__m256i>(v), reinterpret_cast<__m256i>(v)) != 0;
#else
    return (v[0] | v[1] | v[2] | v[3] | v[4] | v[5] | v[6] | v[7]) == 0;
#endif
}

/// Bit n where element n holds.
inline unsigned bitsOf(Int8 v) {
#ifdef __AVX2__
    return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(v)));
#else
    unsigned bits = 0;
    for (int n = 0; n < kWide; ++n) bits |= v[n] ? 1u << n : 0u;
    return bits;
#endif
}

// ---- Functions of numbers ---------------------------------------------------------------------------------

/// exp(−x) for x ≥ 0, relative error below 4e-6; 0 is approached at x = 87.
inline Vec8 expMinus(Vec8 x) {
    const Vec8 limit = Vec8{} + 87.0f;
    x = x < limit ? x : limit;
    const Vec8 t = x * 1.44269504f;                    // −log2 of the result
    const Int8 whole = toInt(t + 0.5f);                // t ≥ 0: truncation rounds to nearest
    const Vec8 f = (toFloat(whole) - t) * 0.69314718f; // in [−0.35, 0.35]
    // Taylor to degree 5: the next term is 0.35^6/720 = 2.5e-6 at most.
    const Vec8 p = 1.0f + f * (1.0f + f * (0.5f + f * (1.0f / 6 + f * (1.0f / 24 + f * (1.0f / 120)))));
    return p * reinterpret_cast<Vec8>((127 - whole) << 23); // 2^−whole by its exponent's bits
}

// a·b + c is rounded once or twice as the compiler likes, and it may like otherwise when the code around changes. Where
// a last bit decides which table entry is met, and with it those of every figure, the choice is fixed.
inline double roundedOnce(double a, double b, double c) { ///< where the processor can
#ifdef __FMA__
    return __builtin_fma(a, b, c);
#else
    return a * b + c;
#endif
}
inline double roundedTwice(double a, double b, double c) {
    volatile double product = a * b;
    return product + c;
}

inline int floorInt(double v) { return static_cast<int>(__builtin_floor(v)); }
inline int ceilInt(double v) { return static_cast<int>(__builtin_ceil(v)); }
inline int smaller(int a, int b) { return a < b ? a : b; }
inline int larger(int a, int b) { return a > b ? a : b; }
inline int clampTo(int v, int lo, int hi) { return v < lo ? lo : (v > hi ? hi : v); }
inline double clampTo(double v, double hi) { return v < 0 ? 0 : (v > hi ? hi : v); } ///< to [0, hi]

/// Room for `count` elements of a piece; not cleared.
template <class T>
T* memory(SweepScratch& scratch, SweepScratch::Slot slot, std::size_t count) {
    return static_cast<T*>(scratch.bytes(slot, count * sizeof(T)));
}

} // namespace
} // namespace pellucid
