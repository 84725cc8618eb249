// A pack of grains as a text file that a person can write, one grain per line:
//     disk     name  x y radius
//     polygon  name  x1 y1  x2 y2  x3 y3 ...
// Words stand apart by spaces or tabs. A line may be empty, and '#' begins a comment.
#pragma once

#include <charconv>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/run/output_file.hpp"
#include "mpm_explicit/setup/packs.hpp"

namespace mpm {

namespace detail {

constexpr std::size_t longest_line = 100000;  // of a polygon with as many corners as there may be

// Refuses a line that is too long, not UTF-8, or holds control characters.
inline void refuse_bad_line(std::string_view line, const std::string& place) {
    require(line.size() <= longest_line, place + ": the line has more than " +
                                             std::to_string(longest_line) +
                                             " letters; this is another kind of file");
    for (std::size_t k = 0, length = 0; k < line.size(); k += length) {
        length = common::utf8_length(line, k);
        const auto byte = static_cast<unsigned char>(line[k]);
        const bool is_control = (byte < 0x20 && byte != '\t') || byte == 0x7F;
        if (length > 0 && !is_control) continue;
        throw common::InputError(
            place + (length == 0
                         ? ": not UTF-8 text; save the file as UTF-8"
                         : ": a control character; this is not a text file, or it is damaged"));
    }
}

// A word for a message, which is short whatever the word.
inline std::string in_quotes(std::string_view word) {
    std::string quoted = "'";
    return quoted.append(word.substr(0, 40)).append(word.size() > 40 ? "...'" : "'");
}

// Refuses a name that could not be written and read again.
inline void require_name(std::string_view name, const std::string& place) {
    const auto fits = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '_';
    };
    require(!name.empty() && name.size() <= 40 && std::all_of(name.begin(), name.end(), fits),
            place + ": " + in_quotes(name) +
                " cannot name a grain: use letters, digits and '_', 40 at most");
}

// A word as a finite number.
inline double read_number(std::string_view word, const std::string& place) {
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    require(error != std::errc::result_out_of_range && (error != std::errc{} || usable(value)),
            place + ": " + in_quotes(word) + " is no number to compute with: give a finite one");
    require(error == std::errc{} && end == word.data() + word.size(),
            place + ": " + in_quotes(word) + " is not a number: write one like 0.25 or 1e-3");
    return value;
}

// The words of a line, up to its comment.
inline std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> words;
    line = line.substr(0, line.find('#'));
    for (;;) {
        const std::size_t begin = line.find_first_not_of(" \t");
        if (begin == std::string_view::npos) return words;
        line.remove_prefix(begin);
        words.push_back(line.substr(0, line.find_first_of(" \t")));
        line.remove_prefix(words.back().size());
    }
}

// Calls visit(words, place) for every line of a text file that has words; place is "file:line".
template <class Visit>
void for_each_line(const std::string& path, const Visit& visit) {
    const std::string text = common::read_file(path);
    std::string_view rest = text;
    if (rest.substr(0, 3) == "\xEF\xBB\xBF") rest.remove_prefix(3);  // the mark of UTF-8
    for (long number = 1; !rest.empty(); ++number) {
        const std::string place = path + ":" + std::to_string(number);
        std::string_view line = rest.substr(0, rest.find('\n'));
        rest.remove_prefix(std::min(rest.size(), line.size() + 1));
        if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
        refuse_bad_line(line, place);
        const std::vector<std::string_view> words = words_of(line);
        if (!words.empty()) visit(words, place);
    }
}

// A grain from the words of its line.
inline PackedGrain read_grain(const std::vector<std::string_view>& words,
                              const std::string& place) {
    const std::string_view kind = words[0];
    require(kind == "disk" || kind == "polygon",
            place + ": unknown word " + in_quotes(kind) + "; a line begins with disk or polygon");
    require(words.size() >= 2,
            place + ": a " + std::string(kind) + " without a name; write its name and its numbers");
    require_name(words[1], place);
    std::vector<double> numbers;
    for (std::size_t k = 2; k < words.size(); ++k) numbers.push_back(read_number(words[k], place));
    const std::size_t n = numbers.size();
    require(kind == "polygon" || n == 3,
            place + ": a disk takes 3 numbers, x y radius, not " + std::to_string(n));
    require(kind == "disk" || (n % 2 == 0 && n >= 6),
            place + ": a polygon takes two numbers, x y, for each of 3 or more corners, not " +
                std::to_string(n) + " numbers");
    const std::string name(words[1]);
    try {
        if (kind == "disk") return {name, disk(numbers[0], numbers[1], numbers[2])};
        std::vector<Point> corners;
        for (std::size_t k = 0; k < n; k += 2) corners.push_back({numbers[k], numbers[k + 1]});
        return {name, polygon(std::move(corners))};
    } catch (const common::InputError& error) {
        throw common::InputError(place + ": " + in_quotes(name) + ": " + error.what());
    }
}

}  // namespace detail

/// Reads a pack of grains.
/// errors: InputError with file and line for what is no pack
inline std::vector<PackedGrain> read_pack(const std::string& path) {
    std::vector<PackedGrain> grains;
    std::map<std::string, std::string> places;
    detail::for_each_line(path, [&](const auto& words, const std::string& place) {
        grains.push_back(detail::read_grain(words, place));
        const std::string number = place.substr(path.size() + 1);
        const auto [earlier, is_new] = places.insert({grains.back().name, number});
        require(is_new, place + ": the name " + detail::in_quotes(grains.back().name) +
                            " is that of line " + earlier->second +
                            " too: give each grain its own");
    });
    require(!grains.empty(), path + ": holds no grain; write lines like: disk left 0.35 0.3 0.2");
    return grains;
}

/// Writes a pack of grains, whole or not at all.
/// exact:  reading it gives the same numbers, and writing those the same bytes
/// errors: InputError for names that could not be read again, and where the file cannot be written
inline void write_pack(const std::string& path, const std::vector<PackedGrain>& grains) {
    require(!grains.empty(), path + ": there is no grain to write: give one at least");
    std::map<std::string, long> names;
    for (const PackedGrain& grain : grains) {
        detail::require_name(grain.name, path);
        require(++names[grain.name] == 1, path + ": two grains have the name " +
                                              detail::in_quotes(grain.name) +
                                              ": give each its own");
    }
    common::OutputFile file(path);
    file.text("# disk name x y radius | polygon name x1 y1 x2 y2 x3 y3 ...\n");
    for (const PackedGrain& grain : grains) {
        const Outline& outline = grain.outline;
        const bool is_disk = outline.kind == OutlineKind::disk;
        file.text((is_disk ? "disk " : "polygon ") + grain.name);
        const auto write = [&](double value) {
            file.text(" ");
            file.text(common::number_text(value));
        };
        if (is_disk) write(outline.x), write(outline.y), write(outline.radius);
        for (const Point& p : outline.corners) write(p.x), write(p.y);
        file.text("\n");
    }
    file.finish();
}

}  // namespace mpm
