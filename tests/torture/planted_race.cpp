// The positive control of the thread sanitizer: a sum that threads add to without a look at each
// other. A laboratory that does not find this race would find none.
#include <chrono>
#include <cstdio>
#include <thread>

#include "common/parallel.hpp"

int main() {
    long sum = 0;
    common::for_each_block(1 << 16, [&](int, long begin, long end) {
        sum += end - begin;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));  // so that both take part
    });
    std::printf("%ld\n", sum);
}
