#pragma once
namespace snag {

/// Double-precision operations a second that one processor does in chains of multiply-adds on vectors, each counted as two; the most of
/// some passes.
double multiply_add_rate();

}  // namespace snag
