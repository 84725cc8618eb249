// Checkpoints whose contents are forged and whose checksums are right: nothing but the validation
// of what was read stands between them and the steps.
#include <doctest/doctest.h>

#include <algorithm>
#include <climits>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "tests/support/any_run.hpp"
#include "tests/torture/forge.hpp"

namespace {

using namespace facts;

using torture::Block, torture::blocks_of, torture::file_of;

template <class Number>
std::string bytes_of(Number value) {
    return {reinterpret_cast<const char*>(&value), sizeof value};
}

// ---- what a forger can do to a block ------------------------------------------------------------

struct Forgery {
    std::size_t block;
    std::string label, bytes;
    bool is_impossible;  // no run could have written it
};

// Values of a type as bytes, with their names, and whether no block may hold them.
std::vector<std::tuple<std::string, std::string, bool>> strange_values(char type) {
    const auto wide = [](const char* name, double x, bool impossible = false) {
        return std::tuple(std::string(name), bytes_of(x), impossible);
    };
    if (type == 'd')
        return {wide("nan", std::nan(""), true),
                wide("inf", std::numeric_limits<double>::infinity(), true),
                wide("-1", -1),
                wide("0", 0),
                wide("1e300", 1e300),
                wide("-1e18", -1e18),
                wide("INT_MAX", INT_MAX)};
    if (type == 'l')
        return {{"-1", bytes_of(-1L), false},
                {"0", bytes_of(0L), false},
                {"LONG_MIN", bytes_of(LONG_MIN), true},
                {"LONG_MAX", bytes_of(LONG_MAX), true}};
    if (type == 'i')
        return {{"-1", bytes_of(-1), false},
                {"0", bytes_of(0), false},
                {"INT_MIN", bytes_of(INT_MIN), true},
                {"INT_MAX", bytes_of(INT_MAX), true}};
    return {{"zero byte", std::string(1, '\0'), false}, {"byte 255", "\xff", false}};
}

std::string swapped(const Block& block, std::size_t a, std::size_t b) {
    std::string bytes = block.bytes;
    const std::size_t w = torture::size_of(block.type);
    for (std::size_t k = 0; k < w; ++k) std::swap(bytes[a * w + k], bytes[b * w + k]);
    return bytes;
}

std::vector<Forgery> forgeries_of(const std::vector<Block>& blocks) {
    std::vector<Forgery> all;
    for (std::size_t k = 0; k < blocks.size(); ++k) {
        const Block& block = blocks[k];
        const std::size_t w = torture::size_of(block.type), n = block.bytes.size() / w;
        const auto add = [&](const std::string& label, const std::string& bytes,
                             bool impossible = false) {
            if (bytes != block.bytes)
                all.push_back({k, block.name + ": " + label, bytes, impossible});
        };
        const bool is_text = block.type == 'c';
        for (const auto& [name, value, impossible] : strange_values(block.type)) {
            std::string everywhere;
            for (std::size_t p = 0; p < n; ++p) everywhere += value;
            add("all are " + name, everywhere, impossible);
            for (const std::size_t p : {std::size_t{0}, n / 2, n - 1}) {
                if (n == 0 || (n == 1 && p > 0)) continue;
                std::string bytes = block.bytes;
                bytes.replace(p * w, w, value);
                add("number " + std::to_string(p) + " is " + name, bytes, impossible);
            }
        }
        add("one longer", block.bytes + (n > 0 ? block.bytes.substr(0, w) : std::string(w, '\0')),
            !is_text);
        add("one shorter", block.bytes.substr(0, n > 0 ? (n - 1) * w : 0), !is_text);
        // There may have been no contact.
        add("empty", "", !is_text && block.name != "active_pairs");
        add("doubled", block.bytes + block.bytes, !is_text);
        if (n < 2) continue;
        add("ends swapped", swapped(block, 0, n - 1));
        add("neighbors swapped", swapped(block, n / 2 - 1, n / 2));
    }
    return all;
}

// ---- runs that are continued from them ----------------------------------------------------------

// Short runs of every program, which end a few steps after their checkpoints.
const std::string cases = R"(
cic mirrors time.end=1
cic floating time.end=4
cic plane_streams time.end=2
pic shock_tube time.end=0.05
pic channel time.end=0.05
fluids swirling time.end=0.08
flip rezoned time.end=0.05 shock_tube
flip falling time.end=0.3 flip.transfer=apic flip.density=particles
mpm_explicit rebound time.end=0.3
mpm_explicit bonded time.end=0.5
mpm_explicit belt time.end=0.02
mpm_implicit rebound time.end=0.3
mpm_implicit press time.end=0.1
implicit_moment sheet time.end=3
implicit_moment streams time.end=1
explicit_em sheet time.end=2
explicit_em streams time.end=1 particles.order=2
)";

struct Count {
    long tried = 0, refused = 0, ran = 0, failed = 0;
};

// in: share, how many of the forgeries of a case are tried, evenly spread; 0: all
void check_forged(long share) {
    std::map<std::string, Count> counts;
    for (const Command& command : commands(cases)) {
        const std::string program = command.program->name, good = folder("good"),
                          out = folder("forged"), path = out + ".bin";
        INFO(program << " " << command.words);
        REQUIRE(run(command, good, "output.checkpoint_steps=4") == 0);
        const std::vector<std::string> kept = checkpoints(good);
        REQUIRE(kept.size() == 2);
        const std::string file = read_all(kept[0]);
        const std::vector<Block> blocks = blocks_of(file);
        REQUIRE(file_of(blocks) == file);
        const std::vector<Forgery> all = forgeries_of(blocks);
        const std::string start =
            "timeout -s KILL 10 " + command_line(program, "--restart " + path) +
            " --quiet --force --threads 1 --out " + out + " >/dev/null 2> " + out + ".stderr";
        // What the folder of a run holds stays where a restart is refused.
        const std::string history = read_all(good + "/history.dat");
        std::vector<Block> far_away = blocks;
        for (Block& block : far_away)
            if (block.name.ends_with("x_p")) torture::put(block, 0, "1e300");
        write_all(good + "/checkpoint_0.bin", file_of(far_away));
        CHECK(shell(command_line(program, "--restart " + good + "/checkpoint_0.bin") +
                    " --quiet >/dev/null 2>/dev/null") == 2);
        CHECK(read_all(good + "/history.dat") == history);

        Count& count = counts[program];
        const long total = long(all.size()), tried = share > 0 ? share : total;
        for (long k = 0; k < tried; ++k) {
            const Forgery& forgery = all[k * total / tried];
            std::vector<Block> forged = blocks;
            forged[forgery.block].bytes = forgery.bytes;
            write_all(path, file_of(forged));
            const int status = shell(start);
            const std::string text = said(out);
            ++count.tried, count.refused += status == 2, count.ran += status == 0;
            count.failed += status == 3;
            INFO(forgery.label << ": status " << status << ", " << text);
            CHECK((status == 2 || status == 0 || status == 3));
            CHECK((!forgery.is_impossible || status == 2));
            CHECK(!holds(text, "unexpected"));
            CHECK(!holds(text, "not enough memory"));
        }
    }
    for (const auto& [program, count] : counts)
        MESSAGE(program << ": " << count.tried << " forgeries, " << count.refused << " refused, "
                        << count.ran << " ran, " << count.failed << " failed");
}

}  // namespace

TEST_CASE("a forged checkpoint is refused or is one that a run could have had" *
          doctest::description("robust")) {
    check_forged(30);
}

TEST_CASE("a history with a row too few or too many is refused" * doctest::description("robust")) {
    const std::string why = "the checkpoint is of no run: its history lacks rows, or has too many";
    for (const Command& command : commands("cic run\nfluids run\ngrains run\nplasmas run\n"
                                           "explicit_em run output.history_steps=2\n"
                                           "grains run output.history_steps=3")) {
        const std::string out = folder("good"), forged = out + "_forged";
        INFO(command.program->name << " " << command.words);
        REQUIRE(run(command, out, "output.checkpoint_steps=4") == 0);
        const std::string header = read_all(out + "/history.dat").substr(0, 10000);
        const std::size_t columns =
            1 + std::count(header.begin(), header.begin() + long(header.find('\n')), ' ');
        for (const std::string& checkpoint : checkpoints(out)) {
            std::vector<Block> blocks = blocks_of(read_all(checkpoint));
            std::string& rows = blocks[5].bytes;
            REQUIRE(blocks[5].name == "history");
            const std::string whole = rows, last = rows.substr(rows.size() - 8 * columns);
            const auto status_with = [&](const std::string& forged_rows) {
                rows = forged_rows;
                write_all(forged + ".bin", file_of(blocks));
                return run(command.program->name, "--restart " + forged + ".bin --force", forged);
            };
            CHECK(status_with(whole) == 0);
            CHECK(status_with(whole.substr(0, whole.size() - 8 * columns)) == 2);
            CHECK(holds(said(forged), why));
            double later = 0;
            std::memcpy(&later, last.data(), sizeof later);
            later += 1e-6;
            CHECK(status_with(whole + bytes_of(later) + last.substr(sizeof later)) == 2);
            CHECK(holds(said(forged), why));
            fs::remove_all(forged);
        }
    }
}

TEST_CASE("every forgery of every block is refused or is one that a run could have had" *
          doctest::description("long")) {
    check_forged(0);
}
