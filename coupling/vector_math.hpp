#pragma once
// exp, log and pow that vectorise: glibc's vector variants (libmvec, 4 units in the last place) are offered to the vectoriser without the
// rest of -ffast-math. Elsewhere the scalar functions are used, and only speed differs.
#include <cmath>

#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__GLIBC__)
extern "C" {
__attribute__((__simd__("notinbranch"))) double exp(double) noexcept;
__attribute__((__simd__("notinbranch"))) double log(double) noexcept;
__attribute__((__simd__("notinbranch"))) double pow(double, double) noexcept;
}
#endif
