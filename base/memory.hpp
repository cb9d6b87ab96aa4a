#pragma once
// The memory of this machine, against which sizes in input are held before anything is allocated.

namespace snag {

/// bytes
double physical_memory();

}  // namespace snag
