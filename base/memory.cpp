#include "base/memory.hpp"

#include <malloc.h>
#include <unistd.h>

namespace snag {

double physical_memory() { return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE)); }

void return_free_memory() { malloc_trim(0); }

}  // namespace snag
