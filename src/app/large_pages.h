// Makes the C library allocate memory in large pages. main() calls it.
#pragma once

namespace troffer {

// Lets later allocations use pages of 2 MiB where the system provides them (Linux with the GNU C
// library; elsewhere it does nothing). Freed memory is kept for reuse. Otherwise the first second
// of a picture goes into page faults of 4 KiB pages. Reserves addresses, but no memory. Call once,
// before other threads exist.
void use_large_pages();

}  // namespace troffer
