#pragma once
// The memory of this machine, against which sizes in input are held before anything is allocated; and that of the program.

namespace snag {

/// bytes
double physical_memory();

/// Returns to the system what was freed: after stages that need much more than what stays. The allocator keeps it otherwise, to some tens
/// of megabytes a block.
void return_free_memory();

}  // namespace snag
