// The positive control of the thread sanitizer: a sum that all threads add to, each without a look at
// the others. A laboratory that does not find this race would find none.
#include <cstdio>

#include "common/parallel.hpp"

int main() {
    long sum = 0;
    common::for_each_block(1 << 16, [&](int, long begin, long end) {
        for (long k = begin; k < end; ++k) sum += k;
    });
    std::printf("%ld\n", sum);
}
