#include "common/run/parameters.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>

#include "common/ranks.hpp"
#include "common/run/formula.hpp"
#include "common/run/sentence.hpp"

namespace common {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Number of single-letter edits between two words; their parts in another order are one.
std::size_t edit_distance(const std::string& a, const std::string& b) {
    if (a != b && std::is_permutation(a.begin(), a.end(), b.begin(), b.end())) return 1;
    const auto lower = [](unsigned char letter) { return std::tolower(letter); };
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = diagonal + (lower(a[i - 1]) == lower(b[j - 1]) ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
        }
    }
    return row.back();
}

std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char letter : text) {
        if (letter == '"' || letter == '\\') result += '\\';
        result += letter;
    }
    return result + "\"";
}

struct Shown {
    std::string operator()(const bool* value) const { return *value ? "true" : "false"; }
    std::string operator()(const long* value) const { return std::to_string(*value); }
    std::string operator()(const double* value) const { return number_text(*value); }
    std::string operator()(const std::string* value) const { return quoted(*value); }
    std::string operator()(const Formula* value) const {
        return value->is_number() ? number_text(*value) : quoted(value->text());
    }
    std::string operator()(const std::optional<double>* value) const {
        return *value ? number_text(**value) : "";
    }
};

std::string kind_of(const Setting& setting) {
    constexpr const char* names[] = {"true or false", "a whole number", "a number", "text",
                                     "a section"};
    return names[setting.value.index()];
}

bool is_word(const std::string& text) {
    const auto allowed = [](unsigned char c) { return std::isalnum(c) || c == '_'; };
    return std::isalpha(static_cast<unsigned char>(text[0])) && std::ranges::all_of(text, allowed);
}

std::string padded(const std::string& text, std::size_t width) {
    return text + std::string(text.size() < width ? width - text.size() : 1, ' ');
}

}  // namespace

Range anything() { return {-infinity, infinity}; }
Range at_least(double low) { return {low, infinity}; }
Range above(double low) { return {low, infinity, true}; }
Range between(double low, double high) { return {low, high}; }

std::string text_of(const Range& range) {
    if (range.low == -infinity && range.high == infinity) return "any";
    if (range.high == infinity) return (range.open_low ? "> " : ">= ") + number_text(range.low);
    return number_text(range.low) + (range.open_low ? " < ... " : " ... ") +
           number_text(range.high);
}

bool contains(const Range& range, double value) {
    return (range.open_low ? value > range.low : value >= range.low) && value <= range.high;
}

std::string number_text(double value) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    return {text, end};
}

std::string format(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    return text;
}

void ParameterTable::add(Entry entry) {
    entry.initial = std::visit(Shown{}, entry.target);
    if (pattern_ != nullptr) return pattern_->push_back(std::move(entry));
    if (groups_.empty()) group("parameters");
    groups_.back().entries.push_back(entries_.size());
    entries_.push_back(std::move(entry));
}

void ParameterTable::describe_expectation() {
    group("what the case exists to show");
    text("expect.fails", expectation.fails,
         "results that may fall short, each \"name\" or \"name from low to high\", with commas "
         "between them, or \"status 3\": it is said to be expected");
    text("expect.because", expectation.because, "why, in a sentence");
}

bool ParameterTable::is_changeable(const std::string& name) const {
    if (name.starts_with("expect.")) return true;
    return std::ranges::any_of(changeable_, [&](const std::string& allowed) {
        return allowed.back() == '.' ? name.starts_with(allowed) : name == allowed;
    });
}

ParameterTable::Entry* ParameterTable::find(const std::string& name) {
    for (Entry& entry : entries_)
        if (entry.name == name) return &entry;
    return nullptr;
}

std::optional<bool> ParameterTable::takes_text(const std::string& name, const std::string& value) {
    const auto is_text = [&](const Entry& entry) {
        double number = 0;
        const char* const end = value.data() + value.size();
        return std::holds_alternative<std::string*>(entry.target) ||
               (std::holds_alternative<Formula*>(entry.target) &&
                std::from_chars(value.data() + value.starts_with('+'), end, number).ptr != end);
    };
    if (const Entry* entry = find(name); entry != nullptr) return is_text(*entry);
    // An item that is new.
    const std::string key = name.substr(name.rfind('.') + 1);
    for (const List& list : lists_)
        for (const Entry& entry : list.pattern)
            if (name.starts_with(list.name + ".") && entry.name == list.name + ".<name>." + key)
                return is_text(entry);
    return std::nullopt;
}

// The name with the word before its first dot spelled like a list; "" where none is near.
std::string ParameterTable::in_nearest_list(const std::string& name) const {
    const std::string section = name.substr(0, name.find('.'));
    for (const Entry& entry : entries_)
        if (entry.name.starts_with(section + ".")) return "";
    for (const List& list : lists_) {
        if (section != list.name && edit_distance(section, list.name) <= 2)
            return list.name + name.substr(section.size());
    }
    return "";
}

std::string ParameterTable::nearest(const std::string& name) const {
    std::string best = in_nearest_list(name);
    if (!best.empty()) return best;
    std::size_t least = std::max<std::size_t>(3, name.size() / 3) + 1;
    for (const Entry& entry : entries_)
        if (const std::size_t distance = edit_distance(name, entry.name); distance < least)
            best = entry.name, least = distance;
    // The right key in the wrong section is the other common slip.
    const std::string key = name.substr(name.rfind('.') + 1);
    for (const Entry& entry : entries_)
        if ((least > 2 || key == name) && entry.name.substr(entry.name.rfind('.') + 1) == key)
            return entry.name;
    return best;
}

// The name that has taken the place of an earlier one; "" for a name that was never in use.
std::string ParameterTable::new_name(const std::string& name) const {
    for (const auto& [before, now] : renamed_) {
        if (name == before) return now;
        if (before.back() == '.' && name.starts_with(before))
            return now + name.substr(before.size());
    }
    return "";
}

// Makes the item that a name like species.beam.density belongs to, if it is new.
void ParameterTable::make_item(const Setting& setting) {
    for (List& list : lists_) {
        const std::string start = list.name + ".";
        if (!setting.name.starts_with(start) || setting.name == start) continue;
        const std::size_t dot = setting.name.find('.', start.size());
        if (dot == std::string::npos) {
            if (find(setting.name) != nullptr) return;  // a section beside its list
            refuse(true, setting.place, ": '", setting.name, "' needs the name of an item: write [",
                   list.name, ".<name>] above its parameters");
        }
        const std::string item = setting.name.substr(start.size(), dot - start.size());
        if (std::ranges::find(list.items, item) != list.items.end()) return;
        refuse(!is_word(item), setting.place, ": '", item,
               "' cannot name an item: use letters, digits and '_', a letter first");
        refuse(list.items.size() == most_items, setting.place, ": more than ", most_items,
               " items in [", list.name, "]: take some out");
        for (const std::string& other : list.items)
            if (setting.place.starts_with("command line") && is_first_rank() &&
                edit_distance(item, other) <= item.size() / 4)
                std::fprintf(stderr, "warning: [%s.%s] is new; the case has [%s.%s]\n",
                             list.name.c_str(), item.c_str(), list.name.c_str(), other.c_str());
        list.items.push_back(item);
        groups_.push_back({list.name + " '" + item + "'", {}});
        list.append(item);
        return;
    }
}

// A section may be empty, and [species.beam] makes a beam of defaults; but it must be a section.
void ParameterTable::accept_empty_section(const Setting& setting) {
    const std::string start = setting.name + ".";
    make_item({start, {}, setting.place});
    const bool known =
        std::ranges::any_of(entries_,
                            [&](const Entry& entry) { return entry.name.starts_with(start); }) ||
        std::ranges::any_of(lists_, [&](const List& list) { return list.name == setting.name; });
    if (known) return;
    const std::string now = new_name(start);
    refuse(!now.empty(), setting.place, ": [", setting.name, "] has a new name: write [",
           now.substr(0, now.size() - !now.empty()), "]");
    std::string guess = in_nearest_list(setting.name);
    if (guess.empty()) {
        const std::string parameter = nearest(setting.name);
        guess = parameter.substr(0, std::min(parameter.rfind('.'), parameter.size()));
    }
    refuse(true, setting.place, ": unknown section [", setting.name, "]",
           guess.empty() ? "; --help lists all" : "; did you mean [" + guess + "]?");
}

void ParameterTable::set(const Setting& setting) {
    if (std::holds_alternative<EmptySection>(setting.value) && find(setting.name) == nullptr)
        return accept_empty_section(setting);
    make_item(setting);
    Entry* entry = find(setting.name);
    if (entry == nullptr) {
        const std::string now = new_name(setting.name), guess = nearest(setting.name);
        refuse(find(now) != nullptr, setting.place, ": '", setting.name,
               "' has a new name: write '", now, "'");
        const bool of_file = !setting.place.starts_with("command line");
        refuse(true, setting.place, ": unknown parameter '", setting.name,
               !guess.empty() ? "'; did you mean '" + guess + "'?" : "'; --help lists all",
               guess.empty() && of_file ? "; is the case one of this program?" : "");
    }
    const auto refuse_value = [&](const auto&... why) {
        refuse(true, setting.place, ": '", setting.name, "'", why...);
    };
    const bool* truth = std::get_if<bool>(&setting.value);
    const long* integer = std::get_if<long>(&setting.value);
    const double* number = std::get_if<double>(&setting.value);
    const std::string* text = std::get_if<std::string>(&setting.value);
    const bool is_number = integer != nullptr || number != nullptr;
    const double value = number != nullptr ? *number : integer != nullptr ? double(*integer) : 0;
    const auto require = [&](bool right_type, const std::string& type) {
        const std::string found = kind_of(setting) + (text != nullptr ? " " + quoted(*text) : "");
        if (!right_type) refuse_value(" takes ", type, ", not ", found);
        if (!is_number) return;
        if (!std::isfinite(value)) refuse_value(" must be finite, not ", number_text(value));
        if (!contains(entry->allowed, value))
            refuse_value(" = ", number_text(value),
                         " is out of range; allowed: ", text_of(entry->allowed),
                         entry->unit.empty() ? "" : " " + entry->unit);
    };
    const auto number_of = [&](const char* type) {
        require(is_number, type);
        // Beyond these sizes, products of several numbers leave double precision.
        const double size = std::fabs(value);
        if (!std::holds_alternative<long*>(entry->target) && size != 0 &&
            !(size > 1e-40 && size < 1e40))
            refuse_value(" = ", number_text(value),
                         " is not between 1e-40 and 1e40 in size: choose other units");
        return value;
    };
    Formula** const formula = std::get_if<Formula*>(&entry->target);
    if (auto flag = std::get_if<bool*>(&entry->target)) {
        require(truth != nullptr, "true or false");
        **flag = *truth;
    } else if (auto whole = std::get_if<long*>(&entry->target)) {
        number_of("a whole number");
        if (value != std::floor(value) || std::fabs(value) > 9007199254740992.0)
            refuse_value(" takes a whole number, not ", number_text(value));
        **whole = long(value);
    } else if (auto real = std::get_if<double*>(&entry->target)) {
        **real = number_of("a number");
    } else if (auto optional = std::get_if<std::optional<double>*>(&entry->target)) {
        **optional = number_of("a number");
    } else if (formula != nullptr && is_number) {
        **formula = number_of("a number");
    } else {
        const std::vector<std::string>& choices = entry->choices;
        std::string list;
        for (const std::string& choice : choices)
            list += (list.empty() ? "" : ", ") + quoted(choice);
        require(text != nullptr, formula        ? "a number or a formula"
                                 : list.empty() ? "text"
                                                : "text, one of " + list);
        if (std::ranges::any_of(*text, [](unsigned char c) { return std::iscntrl(c); }))
            refuse_value(" holds a control character; write plain text");
        if (!choices.empty() && std::ranges::find(choices, *text) == choices.end())
            refuse_value(" = ", quoted(*text), " is not one of ", list);
        if (text->size() > longest_text)
            refuse_value(" has ", text->size(), " letters; write at most ", longest_text, " (",
                         entry->meaning, ")");
        if (formula == nullptr)
            **std::get_if<std::string*>(&entry->target) = *text;
        else if (text->empty())
            refuse_value(" is empty; write a number or a formula");
        else
            **formula = Formula(*text, setting.place + ": '" + setting.name + "'", entry->allowed);
    }
}

std::string ParameterTable::help() const {
    const auto line = [](const Entry& entry) {
        std::string range;
        if (!entry.choices.empty()) {
            for (const std::string& choice : entry.choices)
                range += (range.empty() ? "" : " | ") + choice;
        } else if (std::holds_alternative<bool*>(entry.target)) {
            range = "true | false";
        } else if (std::holds_alternative<std::string*>(entry.target)) {
            range = "text";
        } else {
            range = text_of(entry.allowed);
            if (std::holds_alternative<Formula*>(entry.target))
                range = "formula or number, " + range;
        }
        const std::string unit = entry.unit.empty() ? "" : " [" + entry.unit + "]";
        return "  " + padded(entry.name, 31) + " " + entry.meaning + unit + "\n" +
               std::string(34, ' ') + range + "; default " +
               (entry.initial.empty() ? "none" : entry.initial) + "\n";
    };
    std::string text;
    for (const Group& group : groups_) {
        text += "\n" + group.title + "\n";
        for (const std::size_t index : group.entries) text += line(entries_[index]);
    }
    for (const List& list : lists_) {
        text += "\n[" + list.name + ".<name>]: " + list.meaning + "\n";
        for (const Entry& entry : list.pattern) text += line(entry);
    }
    return text;
}

std::string ParameterTable::effective_case() const {
    std::vector<std::string> sections;
    std::map<std::string, std::string> body;
    for (const Entry& entry : entries_) {
        const std::string shown = std::visit(Shown{}, entry.target);
        if (shown.empty()) continue;
        const std::size_t dot = entry.name.rfind('.');
        const std::string section = entry.name.substr(0, dot);
        if (body.find(section) == body.end()) sections.push_back(section);
        body[section] += entry.name.substr(dot + 1) + " = " + shown + "\n";
    }
    std::string text;
    for (const std::string& section : sections)
        text += (text.empty() ? "[" : "\n[") + section + "]\n" + body[section];
    return text;
}

}  // namespace common
