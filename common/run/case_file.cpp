// Case files: TOML, read by toml++ after the bytes have been looked at. The only source that
// includes toml++.
#include <algorithm>
#include <cctype>
#include <utility>

#include "common/run/parameters.hpp"

#ifndef NDEBUG
#define NDEBUG 1  // the library's assertions are no way to refuse an input
#endif
#include <toml++/toml.h>

namespace common {

std::size_t utf8_length(std::string_view text, std::size_t k) {
    const auto byte = [&](std::size_t n) {
        return k + n < text.size() ? static_cast<unsigned char>(text[k + n]) : 0U;
    };
    const unsigned first = byte(0);
    const std::size_t length = first < 0x80 ? 1 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
    if (length > 1 && (first < 0xC2 || first > 0xF4)) return 0;
    // No longer form than needed, no surrogate, nothing above U+10FFFF.
    const unsigned low = first == 0xE0 ? 0xA0 : (first == 0xF0 ? 0x90 : 0x80);
    const unsigned high = first == 0xED ? 0x9F : (first == 0xF4 ? 0x8F : 0xBF);
    for (std::size_t n = 1; n < length; ++n)
        if (byte(n) < (n == 1 ? low : 0x80) || byte(n) > (n == 1 ? high : 0xBF)) return 0;
    return length;
}

namespace {

// A place in a file; the command line has one line.
std::string at(const std::string& source, std::size_t line, std::size_t column) {
    if (source.starts_with("command line:")) return source;
    return source + ":" + std::to_string(line) + ":" + std::to_string(column);
}

// Also bounds how deeply names can be nested: one level takes two letters.
constexpr std::size_t longest_line = 2000;

// Refuses what is not UTF-8 text, and letters that TOML takes only in strings and comments; the
// library is not safe on either.
void refuse_bad_bytes(const std::string& text, const std::string& source) {
    std::size_t line = 1, column = 1;
    char inside = '\n';  // a string that ends with this quote, a comment, or neither
    for (std::size_t k = 0; k < text.size();) {
        const std::size_t length = utf8_length(text, k);
        const auto byte = static_cast<unsigned char>(text[k]);
        const auto refuse = [&](const std::string& why) {
            throw InputError(at(source, line, column) + ": " + why);
        };
        if (length == 0) refuse("not UTF-8 text; save the file as UTF-8");
        const bool allowed = byte == '\t' || byte == '\n' ||
                             (byte == '\r' && k + 1 < text.size() && text[k + 1] == '\n');
        if ((byte < 0x20 && !allowed) || byte == 0x7F)
            refuse("a control character; this is not a text file, or it is damaged");
        if (column > longest_line)
            refuse("the line has more than " + std::to_string(longest_line) +
                   " letters; is it a case file? Polygons of many corners go into a pack");
        const bool is_mark = k == 0 && text.compare(0, 3, "\xEF\xBB\xBF") == 0;  // of UTF-8
        if (byte >= 0x80 && inside == '\n' && !is_mark)
            refuse("'" + text.substr(k, length) +
                   "' may stand in text and comments only; use letters without accents");
        // Three quotes begin text of several lines, which no parameter takes.
        if (inside == '\n' && (text.compare(k, 3, "\"\"\"") == 0 || text.compare(k, 3, "'''") == 0))
            refuse("write text between single quotes, on one line");
        const bool escaped = inside == '"' && byte == '\\' && k + 1 < text.size();
        if (byte == '\n' || (byte == inside && inside != '#'))
            inside = '\n';
        else if (inside == '\n' && (byte == '"' || byte == '\'' || byte == '#'))
            inside = text[k];
        if (escaped && (text[k + 1] == '"' || text[k + 1] == '\\')) ++column, ++k;
        column = byte == '\n' ? 1 : column + 1;
        if (byte == '\n') ++line;
        k += length;
    }
}

// A setting and where it stands, so that settings can be put in the order of the file again: the
// library keeps tables sorted by key.
struct Placed {
    Setting setting;
    std::pair<std::size_t, std::size_t> position;
};

bool is_name_letter(unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; }

void flatten(const toml::table& table, const std::string& prefix, const std::string& source,
             std::vector<Placed>& settings) {
    for (const auto& [key, node] : table) {
        const std::string word(key.str());
        const std::string name = prefix + word;
        const auto begin = node.source().begin;
        const std::string place = at(source, begin.line, begin.column);
        const auto add = [&](const auto& value) {
            settings.push_back({{name, value, place}, {begin.line, begin.column}});
        };
        if (!std::ranges::all_of(word, is_name_letter))
            throw InputError(place + ": '" + word +
                             "' is not a name: use letters, digits and '_', and dots only between "
                             "section and key");
        const auto* inner = node.as_table();
        if (inner != nullptr && inner->empty()) {
            add(EmptySection{});
        } else if (inner != nullptr) {
            flatten(*inner, name + ".", source, settings);
        } else if (const auto* truth = node.as_boolean()) {
            add(truth->get());
        } else if (const auto* whole = node.as_integer()) {
            add(long(whole->get()));
        } else if (const auto* real = node.as_floating_point()) {
            add(real->get());
        } else if (const auto* text = node.as_string()) {
            add(text->get());
        } else {
            throw InputError(place + ": '" + name +
                             "' is a list or a date; parameters are numbers, text, true or false");
        }
    }
}

}  // namespace

std::vector<Setting> read_case(const std::string& text, const std::string& source) {
    refuse_bad_bytes(text, source);
    std::vector<Placed> placed;
    try {
        flatten(toml::parse(std::string_view(text), source), "", source, placed);
    } catch (const toml::parse_error& error) {
        const auto begin = error.source().begin;
        const std::string why(error.description());
        throw InputError(at(source, begin.line, begin.column) + ": " + why +
                         (why.ends_with("value type") ? "; text stands in quotes" : ""));
    }
    std::ranges::stable_sort(placed, {}, &Placed::position);
    std::vector<Setting> settings;
    for (Placed& one : placed) settings.push_back(std::move(one.setting));
    return settings;
}

}  // namespace common
