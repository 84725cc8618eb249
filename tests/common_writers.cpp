// Facts about the files that gnuplot and ParaView read, and about checkpoints, histories and
// summaries.
#include <doctest/doctest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "common/random.hpp"
#include "common/run/checkpoint.hpp"
#include "common/run/history.hpp"
#include "common/run/summary.hpp"
#include "common/run/writers.hpp"

namespace {

namespace fs = std::filesystem;

// A folder of its own for each test, removed at its end.
struct Folder {
    fs::path path = fs::temp_directory_path() / ("writers_" + std::to_string(getpid()));
    Folder() { fs::create_directories(path); }
    ~Folder() { fs::remove_all(path); }
    std::string file(const std::string& name) const { return (path / name).string(); }
};

std::string read_all(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<double> awkward_numbers(int n) {
    std::vector<double> values;
    for (int i = 0; i < n; ++i)
        values.push_back(common::gaussian(1, 0, i, 0) * std::pow(10.0, i % 40 - 20));
    values[0] = 0.1;
    values[1] = -0.0;
    values[2] = std::numeric_limits<double>::denorm_min();
    values[3] = std::numeric_limits<double>::max();
    return values;
}

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

// Checks that tags open and close in order and returns their number, or -1.
int count_tags(const std::string& xml) {
    std::vector<std::string> open;
    int tags = 0;
    for (std::size_t at = xml.find('<'); at != std::string::npos; at = xml.find('<', at + 1)) {
        const std::size_t end = xml.find('>', at);
        if (end == std::string::npos) return -1;
        std::string tag = xml.substr(at + 1, end - at - 1);
        if (tag[0] == '?') continue;
        if (tag.find('<') != std::string::npos) return -1;
        if (tag[0] == '/') {
            if (open.empty() || open.back() != tag.substr(1)) return -1;
            open.pop_back();
        } else {
            if (std::count(tag.begin(), tag.end(), '"') % 2 != 0) return -1;
            open.push_back(tag.substr(0, tag.find(' ')));
            ++tags;
        }
    }
    return open.empty() ? tags : -1;
}

// The numbers of the data array of that name.
template <class Number>
std::vector<Number> data_array(const std::string& xml, const std::string& name) {
    const std::size_t at = xml.find("Name=\"" + name + "\"");
    REQUIRE(at != std::string::npos);
    const std::size_t begin = xml.find(">\n", at) + 2, end = xml.find('\n', begin);
    const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    unsigned bits = 0;
    int have = 0;
    for (std::size_t i = begin; i < end && xml[i] != '='; ++i) {
        bits = (bits << 6) | unsigned(letters.find(xml[i]));
        have += 6;
        if (have >= 8) bytes += char((bits >> (have -= 8)) & 255u);
    }
    CHECK((end - begin) % 4 == 0);
    std::uint64_t size = 0;
    std::memcpy(&size, bytes.data(), 8);
    CHECK(bytes.size() == size + 8);
    std::vector<Number> numbers(size / sizeof(Number));
    if (size > 0) std::memcpy(numbers.data(), bytes.data() + 8, size);
    return numbers;
}

}  // namespace

TEST_CASE("a table read back has the bits that were written") {
    const Folder folder;
    const auto a = awkward_numbers(500), b = std::vector<double>(500, 1.0 / 3.0);
    common::write_table(folder.file("t.dat"), {{"time", "1/omega_pi", a}, {"b", "", b}});
    std::ifstream in(folder.file("t.dat"));
    std::string line, first, second;
    std::getline(in, line);
    CHECK(line == "time b");
    std::getline(in, line);
    CHECK(line == "# units: time 1/omega_pi");
    for (std::size_t i = 0; i < a.size(); ++i) {
        in >> first >> second;
        CHECK(same_bits(std::strtod(first.c_str(), nullptr), a[i]));
        CHECK(same_bits(std::strtod(second.c_str(), nullptr), b[i]));
    }
    const bool more = bool(in >> first);
    CHECK_FALSE(more);
    CHECK_FALSE(fs::exists(folder.file("t.dat.partial")));
}

TEST_CASE("a field file has an empty line after each row of the mesh") {
    const Folder folder;
    std::vector<double> f;
    for (int k = 0; k < 12; ++k) f.push_back(k * k);
    const common::Snapshot at{folder.file(""), 400, 40.5};
    common::write_fields(at, "f", {"x", "d_i", -1.0, 0.5, 4}, {"z", "d_i", 2.0, 0.25, 3},
                         {{"f", "B0", f}});
    std::istringstream in(read_all(folder.file("f_000400.dat")));
    std::string line;
    std::getline(in, line);
    CHECK(line == "x z f");
    std::getline(in, line);
    CHECK(line == "# units: x d_i, z d_i, f B0");
    std::getline(in, line);
    CHECK(line == "# time 40.5 step 400");
    common::Snapshot sample = at;
    sample.particles = 1000000;
    common::write_table(sample, "p", {{"x", "d_i", f}});
    CHECK(read_all(folder.file("p_000400.dat"))
              .starts_with("x\n# units: x d_i\n# time 40.5 step 400 particles 1000000\n0\n1\n4\n"));
    for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 4; ++i) {
            std::getline(in, line);
            double x = 0, z = 0, value = 0;
            std::istringstream(line) >> x >> z >> value;
            CHECK(x == -1.0 + 0.5 * i);
            CHECK(z == 2.0 + 0.25 * j);
            CHECK(value == f[4 * j + i]);
        }
        std::getline(in, line);
        CHECK(line.empty());
    }
    const bool more = bool(std::getline(in, line));
    CHECK_FALSE(more);
}

TEST_CASE("an image file is well-formed XML that holds every value") {
    const Folder folder;
    const auto s = awkward_numbers(15), x = awkward_numbers(15), y = std::vector<double>(15, 2.0),
               z = std::vector<double>(15, -3.0);
    common::write_vti({folder.file(""), 7, 0.125}, "f",
                      {{{"x", "d_i", -1.0, 0.5, 5}, {}, {"z", "d_i", 0.0, 0.25, 3}}},
                      {{"a<b & \"c\"", "", s}}, {{"B", "B0", x, y, z}});
    const std::string xml = read_all(folder.file("f_000007.vti"));
    CHECK(count_tags(xml) == 9);
    CHECK(xml.find("Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">0.125<") !=
          std::string::npos);
    CHECK(xml.find(
              "<ImageData WholeExtent=\"0 4 0 0 0 2\" Origin=\"-1 0 0\" Spacing=\"0.5 1 0.25\">") !=
          std::string::npos);
    const auto scalars = data_array<double>(xml, "a&lt;b &amp; &quot;c&quot;");
    const auto vectors = data_array<double>(xml, "B [B0]");
    CHECK(scalars.size() == 15);
    CHECK(vectors.size() == 45);
    for (std::size_t i = 0; i < 15; ++i) {
        CHECK(same_bits(scalars[i], s[i]));
        CHECK(same_bits(vectors[3 * i], x[i]));
        CHECK(vectors[3 * i + 1] == 2.0);
        CHECK(vectors[3 * i + 2] == -3.0);
    }
}

TEST_CASE("a particle file is well-formed XML that holds every particle") {
    const Folder folder;
    for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{7}}) {
        auto x = awkward_numbers(10);
        x.resize(n);
        const std::vector<double> zero(n, 0.0), w(n, 1.5);
        common::write_vtp({folder.file(""), 0, 0}, "p", {"position", "d_i", x, zero, x},
                          {{"weight", "", w}}, {{"v", "c", x, x, zero}});
        const std::string xml = read_all(folder.file("p_000000.vtp"));
        CHECK(count_tags(xml) == 13);
        const std::string count = "\"" + std::to_string(n) + "\"";
        CHECK(xml.find("NumberOfPoints=" + count + " NumberOfVerts=" + count) != std::string::npos);
        const auto points = data_array<double>(xml, "Points");
        const auto offsets = data_array<std::int64_t>(xml, "offsets");
        const auto connectivity = data_array<std::int64_t>(xml, "connectivity");
        CHECK(points.size() == 3 * n);
        CHECK(data_array<double>(xml, "weight").size() == n);
        CHECK(data_array<double>(xml, "v [c]").size() == 3 * n);
        REQUIRE(offsets.size() == n);
        REQUIRE(connectivity.size() == n);
        for (std::size_t i = 0; i < n; ++i) {
            CHECK(same_bits(points[3 * i + 2], x[i]));
            CHECK(connectivity[i] == std::int64_t(i));
            CHECK(offsets[i] == std::int64_t(i + 1));
        }
    }
}

TEST_CASE("a list of files by time forgets what a restart has undone") {
    const Folder folder;
    const std::vector<double> one(1, 1.0);
    const auto write = [&](long step, double time) {
        common::write_vtp({folder.file(""), step, time}, "p", {"position", "", one, one, one}, {},
                          {});
    };
    write(0, 0), write(10, 1), write(20, 2), write(30, 3);
    write(20, 2.5);
    const std::string xml = read_all(folder.file("p.pvd"));
    std::string times;
    const std::string start = "<DataSet timestep=\"";
    for (std::size_t at = 0; (at = xml.find(start, at)) != std::string::npos;) {
        at += start.size();
        times += xml.substr(at, xml.find("/>", at) - at) + "\n";
    }
    CHECK(times ==
          "0\" file=\"p_000000.vtp\"\n1\" file=\"p_000010.vtp\"\n2.5\" file=\"p_000020.vtp\"\n");
}

TEST_CASE("a format that the program cannot write is refused before the run") {
    common::require_formats({true, false});
    if (common::has_openpmd())
        common::require_formats({false, true});
    else
        CHECK_THROWS_WITH_AS(common::require_formats({false, true}),
                             doctest::Contains("built without HDF5"), common::InputError);
}

TEST_CASE("an axis without a name has no column") {
    const Folder folder;
    const std::vector<double> f{1, 4, 9};
    common::write_fields(folder.file("f.dat"), {"x", "d_i", 0, 0.5, 3}, {"", "", 7, 1, 1},
                         {{"f", "1", f}});
    CHECK(read_all(folder.file("f.dat")) == "x f\n# units: x d_i\n0 1\n0.5 4\n1 9\n\n");
}

TEST_CASE("a file that cannot be written is refused with its path") {
    const Folder folder;
    const std::vector<double> a(3, 1.0), b(4, 1.0);
    const auto message = [&](const std::string& path,
                             const std::vector<common::ScalarColumn>& columns) {
        try {
            common::write_table(path, columns);
        } catch (const common::InputError& error) {
            return std::string(error.what());
        }
        return std::string("written");
    };
    const std::string missing = folder.file("no/such/folder/t.dat");
    CHECK(message(missing, {{"a", "", a}}).find(missing) == 0);
    CHECK(message("/dev/null", {{"a", "", a}}).find("not a regular file") != std::string::npos);
    CHECK(message(folder.file("t.dat"), {{"a", "", a}, {"b", "", b}}).find("column 'b'") !=
          std::string::npos);
    CHECK_FALSE(fs::exists(folder.file("t.dat")));
    fs::create_directories(folder.file("folder.dat"));
    CHECK(message(folder.file("folder.dat"), {{"a", "", a}}).find("not a regular file") !=
          std::string::npos);
}

TEST_CASE("a file that was not finished leaves nothing behind and keeps the old one") {
    const Folder folder;
    const std::string path = folder.file("t.dat");
    common::write_table(path, {{"a", "", std::vector<double>(2, 1.0)}});
    const std::string before = read_all(path);
    {
        common::OutputFile file(path);
        file.text("half of it");
    }
    CHECK(read_all(path) == before);
    CHECK_FALSE(fs::exists(path + ".partial"));
}

TEST_CASE("a full disk is reported with the path and leaves nothing behind") {
    const Folder folder;
    const std::string path = folder.file("t.dat");
    const std::vector<double> many(100000, 1.0 / 3.0);
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    rlimit limit = before;
    limit.rlim_cur = 100000;
    setrlimit(RLIMIT_FSIZE, &limit);
    std::string message = "written";
    try {
        common::write_table(path, {{"a", "", many}});
    } catch (const common::InputError& error) {
        message = error.what();
    }
    setrlimit(RLIMIT_FSIZE, &before);
    CHECK(message.find(path + ": cannot be written") == 0);
    CHECK_FALSE(fs::exists(path));
    CHECK_FALSE(fs::exists(path + ".partial"));
}

TEST_CASE("a checkpoint replaces regular files only and leaves no half of one") {
    const Folder folder;
    const std::string target = folder.file("checkpoint");
    const auto write = [&] {
        common::CheckpointWriter({"implicit_moment", "1", "", ""}, target, "", "").finish();
    };
    fs::create_symlink("elsewhere", target);
    CHECK_THROWS_AS(write(), common::InputError);
    fs::remove(target);
    fs::create_directory(target);
    CHECK_THROWS_AS(write(), common::InputError);
    fs::remove(target);
    write();
    CHECK(fs::is_regular_file(target));
    CHECK(!fs::exists(target + ".partial"));
}

TEST_CASE("an error bar enters the verdict and an expected failure is none") {
    const Folder folder;
    common::Summary numbers;
    numbers.expectation = {"off, fine, misspelled", "the step is too long"};
    numbers.result("near", {1.25, 0.2}, "m", 1, 0.1, "exact");
    numbers.result("certain", {2.0, 0.2}, "m", 1, 0.1, "exact");
    numbers.result("close", {1.15, 0.06}, "m", 1, 0.1, "exact");
    numbers.hint("lower time.dt");
    numbers.result("far", {1.25, 0.06}, "m", 1, 0.1, "exact");
    numbers.result("off", 3, "m", 1, 0.1, "exact");
    numbers.result("fine", 1, "m", 1, 0.1, "exact");
    numbers.result_at_most("low", 1.3, "", 1.2, "bound");
    numbers.result_at_least("high", 1.3, "", 1.2, "bound");
    numbers.result_at_most("lost", std::nan(""), "", 1.2, "bound");
    const std::string path = folder.file("numbers.json");
    numbers.write(path, {"p", "1", "", ""}, "c", 0, "m");
    const auto results = nlohmann::json::parse(read_all(path))["results"];
    const std::vector<std::pair<std::string, std::string>> expected{
        {"near", "NOT MEASURED"}, {"certain", "FAIL"}, {"close", "PASS"},
        {"far", "FAIL"},          {"low", "FAIL"},     {"off", "EXPECTED FAILURE"},
        {"fine", "PASS"},         {"high", "PASS"},    {"lost", "FAIL"}};
    for (const auto& one : expected) {
        const std::string name = one.first, verdict = one.second;
        CAPTURE(name);
        CHECK(results[name]["verdict"] == verdict);
        CHECK(results[name]["pass"] == (verdict == "PASS"));
    }
    CHECK(results["near"]["error"] == 0.2);
    CHECK(results["low"]["at_most"] == 1.2);
    CHECK(results["far"]["hint"] == "lower time.dt");
    for (const char* name : {"certain", "fine", "off"}) CHECK_FALSE(results[name].contains("hint"));
    CHECK(numbers.table().find("<= 1.2") != std::string::npos);
    const std::vector<std::string> said = numbers.shortfalls();
    const auto says = [&](const std::string& text) {
        return std::count(said.begin(), said.end(), text) == 1;
    };
    CHECK(says("FAIL far = 1.25 +- 0.06, and 1 +- 0.1 is expected (exact); lower time.dt"));
    CHECK(says("as expected, off = 3 and not 1 +- 0.1: the step is too long"));
    CHECK(says("expect.fails names 'misspelled', and this run judges no such result"));
    CHECK(says("expect.fails names 'fine', and it passed"));
    CHECK(numbers.fell_short());
}

TEST_CASE("a case that exists to show a failure does not fall short by it") {
    common::Summary numbers;
    numbers.expectation = {"off, status 3", "the step is too long"};
    CHECK(numbers.expectation.names("status 3"));
    numbers.result("off", 3, "m", 1, 0.1, "exact");
    CHECK(!numbers.fell_short());
    numbers.result("other", 3, "m", 1, 0.1, "exact");
    CHECK(numbers.fell_short());
}

TEST_CASE("a failure of another size than the case shows is a failure") {
    common::Summary numbers;
    numbers.expectation = {
        "off from 2 to 4, far from 2 to 4, odd from 2 to 4 m, lost, low from -.4 to 1e-1",
        "so it is"};
    numbers.result("off", 3, "m", 1, 0.1, "exact");
    numbers.result("far", 4.5, "m", 1, 0.1, "exact");
    numbers.result("odd", 3, "m", 1, 0.1, "exact");
    numbers.result("lost", std::nan(""), "m", 1, 0.1, "exact");
    numbers.result_at_least("low", -0.3, "m", 1, "bound");
    const std::vector<std::string> said = numbers.shortfalls();
    const auto says = [&](const std::string& text) {
        return std::ranges::any_of(said, [&](const auto& one) { return one.starts_with(text); });
    };
    for (const char* words :
         {"as expected, off = 3 and not 1 +- 0.1: so it is",
          "as expected, low = -0.3 and not >= 1: so it is",
          "FAIL far = 4.5, and 1 +- 0.1 is expected", "FAIL odd = 3", "FAIL lost = nan",
          "expect.fails names 'far from 2 to 4', and it fails with another value",
          "expect.fails names 'odd from 2 to 4 m', and this run judges no such result"}) {
        CAPTURE(words);
        CHECK(says(words));
    }
    CHECK(numbers.fell_short());
}

TEST_CASE("a number that is not finite is never hidden") {
    const Folder folder;
    common::Summary numbers;
    numbers.result("good", 1, "m", 1, 0.1, "exact");
    CHECK(numbers.is_finite());
    numbers.result("bad", std::nan(""), "m", 1, 0.1, "exact");
    CHECK(!numbers.is_finite());
    const std::string path = folder.file("numbers.json");
    numbers.write(path, {"p", "1", "", ""}, "c", 3, "m");
    const auto results = nlohmann::json::parse(read_all(path))["results"];
    CHECK(results["bad"]["pass"] == false);
    CHECK(results["bad"]["finite"] == false);
    CHECK(results["good"]["pass"] == true);
    CHECK(results["good"]["verdict"] == "PASS");

    common::History history(folder.file("history.dat"));
    history.columns({{{"time", "s"}, {"x", "m"}}, {}});
    const std::vector<double> fine{0, 1}, broken{1, std::nan("")}, more{1, 2, 3};
    history.row(fine);
    CHECK_THROWS_AS(history.row(broken), common::NumericalError);
    CHECK_THROWS(history.row(more));
    history.flush();
    CHECK(read_all(folder.file("history.dat")) == "time x\n# units: time s, x m\n0 1\n");
    CHECK(history.column("x") == std::vector<double>{1});
    CHECK_THROWS(history.column("y"));
}
