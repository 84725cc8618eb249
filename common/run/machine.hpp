// What a program asks of the machine that it runs on, before it reads its case and at its end.
#pragma once

#include <string>

namespace common {

/// Opens the null device on the descriptors 0, 1 and 2 that are closed, so that no file of the run
/// gets one of these numbers and with it what is meant for the terminal.
void open_standard_descriptors();

/// Starts the program again, once, so that threads that wait for work soon give their core away:
/// libgomp reads this from the environment when it is loaded, and by default its threads spin for
/// milliseconds, each of them on a core that other work could use, the thread waited for included.
/// in:   argv of main
/// note: does nothing where OMP_WAIT_POLICY, GOMP_SPINCOUNT or KMP_BLOCKTIME is set.
void share_cores(char** argv);

/// Cores that this process may use: those of its affinity, and not more than the quota of its
/// control group; at least 1.
int free_cores();

/// Memory that one of several alike processes may take: its share of that of the machine and of its control
/// group, and not more than the limit of its shell.
double memory_limit_bytes(int processes);

/// Largest memory that this program had at a time, not counting the program that started it.
double peak_memory_bytes();

/// Text as one word of a shell command.
std::string shell_word(const std::string& text);

}  // namespace common
