// Linked into every program and test by `make TRAP=1`: an invalid operation (0/0, inf - inf, the
// root of a negative number, a comparison with NaN) or a division by zero ends the program with
// SIGFPE where it happens. Threads inherit the traps from the thread that starts them. With
// UNTRAPPED in the environment there are none, for runs that must end in numbers that are not finite.
#include <cfenv>
#include <cstdlib>

namespace {

[[maybe_unused]] const int traps_before =
    std::getenv("UNTRAPPED") == nullptr ? feenableexcept(FE_INVALID | FE_DIVBYZERO) : 0;

}  // namespace
