// What only the browser's build has: between two steps of a program the page is shown the history and
// the picture, and may let the program wait.
//
// Run::not_finished, which every loop asks before a step, is wrapped by the linker. The program is
// left there and entered again (Asyncify), so that its worker can listen to the page.
#include <emscripten.h>

#include <cmath>

#include "common/run/run.hpp"
#include "common/run/writers.hpp"

// Handed to the page by worker.js. A list of numbers is a place in memory and a length.
// clang-format off
EM_JS(int, page_wants, (const char* kind), { return Module.kind === UTF8ToString(kind); })
EM_JS(void, page_add_axis, (const char* name, const char* unit, double low, double step, double count), {
    Module.picture.axes.push({name: UTF8ToString(name), unit: UTF8ToString(unit), low, step, count});
})
EM_JS(void, page_add_column, (const char* name, const char* unit, const double* values, int count), {
    const numbers = new Float32Array(HEAPF64.subarray(values >> 3, (values >> 3) + count));
    Module.picture.columns[UTF8ToString(name)] = {unit: UTF8ToString(unit), numbers};
})
EM_JS(void, page_show_picture, (), { Module.showPicture(); })
EM_JS(void, page_add_rows, (const double* values, int count, double done), {
    Module.addRows(HEAPF64.slice(values >> 3, (values >> 3) + count), done);
})
EM_JS(void, page_end, (int status), { Module.end(status); })
EM_JS(void, page_wait, (double ms), { Asyncify.handleAsync(() => Module.wait(ms)); })
// clang-format on

// main of the program, under the name that the build gives it.
int program_main(int argc, char** argv);

namespace {

constexpr double shortest_ms =
    30;  // from one picture to the next, and between two looks at the page

bool paused = false;
double ms_per_picture = 0;  // 0: as fast as the program goes, with some of its pictures
long pictures_to_show = 1;  // although it is paused
double last_picture = -1e9, last_wait = -1e9;
bool picture_is_new = false;    // since the last wait
bool at_the_end = false;        // what is written after the loop is shown in any case
std::size_t numbers_shown = 0;  // of the history

// Between two steps.
void show_and_wait(const common::Run& run, bool more, double done) {
    const double now = emscripten_get_now();
    const bool in_time = ms_per_picture > 0 ? !picture_is_new : now - last_wait < shortest_ms;
    const bool go_on = paused ? pictures_to_show > 0 : in_time;
    if (more && go_on) return;
    const auto& rows = run.history.all();
    if (rows.size() > numbers_shown)
        page_add_rows(rows.data() + numbers_shown, int(rows.size() - numbers_shown), done);
    numbers_shown = rows.size();
    at_the_end = !more;
    if (!more) return;
    do {
        page_wait(last_picture + ms_per_picture - emscripten_get_now());
    } while (paused && pictures_to_show == 0);
    picture_is_new = false;
    last_wait = emscripten_get_now();
}

}  // namespace

namespace common {

void show_columns(const std::string& kind, const std::vector<ScalarColumn>& columns,
                  const SampledAxis& x, const SampledAxis& z) {
    const double now = emscripten_get_now();
    if (!page_wants(kind.c_str())) return;
    if (ms_per_picture == 0 && !paused && !at_the_end && now - last_picture < shortest_ms) return;
    last_picture = now;
    picture_is_new = true;
    if (pictures_to_show > 0) --pictures_to_show;
    for (const SampledAxis& axis : {x, z})
        page_add_axis(axis.name.c_str(), axis.unit.c_str(), axis.first, axis.step,
                      double(axis.count));
    for (const ScalarColumn& column : columns)
        page_add_column(column.name.c_str(), column.unit.c_str(), column.values.data(),
                        int(column.values.size()));
    page_show_picture();
}

}  // namespace common

int main(int argc, char** argv) {
    const int status = program_main(argc, argv);
    page_end(status);
    return status;
}

extern "C" {

// The x that chi-square with f degrees of freedom stays below with the probability P. GSL's own has the half of GSL
// behind it; this is the series of the incomplete gamma function, and bisection.
double gsl_cdf_chisq_Pinv(double P, double f) {
    const auto below = [f](double x) {
        double term = 1, sum = 1;
        for (double n = 0.5 * f + 1; term > 1e-17 * sum; ++n) sum += term *= 0.5 * x / n;
        return sum * std::exp(0.5 * f * std::log(0.5 * x) - 0.5 * x - std::lgamma(0.5 * f + 1));
    };
    double low = 0, high = 1;
    while (below(high) < P) high *= 2;
    for (int n = 0; n < 100; ++n) (below(0.5 * (low + high)) < P ? low : high) = 0.5 * (low + high);
    return low;
}

// For the page: whether to pause, and how long a picture stays; one more picture in a pause.
EMSCRIPTEN_KEEPALIVE void set_pace(int pause, double ms) {
    paused = pause != 0, ms_per_picture = ms;
}
EMSCRIPTEN_KEEPALIVE void show_one_picture() { pictures_to_show = 1; }

bool __real__ZN6common3Run12not_finishedEll(common::Run*, long, long);
bool __wrap__ZN6common3Run12not_finishedEll(common::Run* run, long step, long steps) {
    const bool more = __real__ZN6common3Run12not_finishedEll(run, step, steps);
    show_and_wait(*run, more, double(step) / double(steps));
    return more;
}
bool __real__ZN6common3Run12not_finishedEldd(common::Run*, long, double, double);
bool __wrap__ZN6common3Run12not_finishedEldd(common::Run* run, long step, double time, double end) {
    const bool more = __real__ZN6common3Run12not_finishedEldd(run, step, time, end);
    show_and_wait(*run, more, time / end);
    return more;
}

}  // extern "C"
