#pragma once
// Length of a vector that changes by little again and again.
#include <cstddef>
#include <vector>

namespace snag {

/// Gives the vector n entries, with room for some more where it has to move: it would else double what it takes.
template <class T>
void resize_with_room(std::vector<T>& field, std::size_t n) {
  if (n > field.capacity()) field.reserve(n + n / 64);
  field.resize(n);
}

}  // namespace snag
