// Memory in large pages.
#pragma once

namespace troffer {

// Has what is allocated from here on lie in pages of 2 MiB, where the system lends them (Linux with
// the GNU C library; elsewhere nothing happens), and kept when it is freed, for what comes next: a
// picture's first second is spent on memory, whose usual pages of 4 KiB are lent one by one. Takes
// no memory by itself, addresses alone. Call once, before there are other threads.
void use_large_pages();

}  // namespace troffer
