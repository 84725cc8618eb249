// The table of a program's parameters, and the command line that fills it.
//
// One table drives the case file, the overrides on the command line, --help and the dump of the
// effective case. It binds names to the fields of a plain struct, whose initial values are the
// defaults.
#pragma once

#include <cmath>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace common {

/// Impossible input: one sentence that says where, what and what to do. The program ends with
/// status 2.
struct InputError : std::runtime_error {
    using runtime_error::runtime_error;
};

/// A computation that failed: one sentence that says where and when. The program ends with
/// status 3.
struct NumericalError : std::runtime_error {
    using runtime_error::runtime_error;
};

/// The values a number may take; an open end is not among them.
struct Range {
    double low, high;
    bool open_low = false;
};
/// Every number.
Range anything();
/// low and more.
Range at_least(double low);
/// More than low.
Range above(double low);
/// low to high, both allowed.
Range between(double low, double high);
bool contains(const Range& range, double value);
std::string text_of(const Range& range);

class Formula;

/// A section of a case file without any key.
struct EmptySection {};

/// One value of a case file or of the command line, with the place it came from for messages.
struct Setting {
    std::string name;
    std::variant<bool, long, double, std::string, EmptySection> value;
    std::string place;
};

/// What a case exists to show, from its section [expect].
struct Expectation {
    // Results, each with "from low to high" behind it or without, or "status 3", with commas between them;
    // and a sentence.
    std::string fails, because;
    struct Failure {
        std::string text, name;
        double low = -HUGE_VAL, high = HUGE_VAL;
    };
    std::vector<Failure> list() const;
    bool names(const std::string& result, double value = 0) const;
};

class ParameterTable {
   public:
    /// A heading in --help.
    void group(const std::string& title) { groups_.push_back({title, {}}); }

    /// A number: a double, a Formula where text may give one, or a std::optional<double> that need
    /// not be given and is not in the effective case then.
    template <class Number>
    void real(const std::string& name, Number& value, const std::string& unit, Range allowed,
              const std::string& meaning) {
        add({name, unit, meaning, &value, allowed, {}, {}});
    }
    /// A whole number; 1e5 is one.
    void whole(const std::string& name, long& value, const std::string& unit, Range allowed,
               const std::string& meaning) {
        add({name, unit, meaning, &value, allowed, {}, {}});
    }
    void flag(const std::string& name, bool& value, const std::string& meaning) {
        add({name, "", meaning, &value, anything(), {}, {}});
    }
    void choice(const std::string& name, std::string& value,
                const std::vector<std::string>& choices, const std::string& meaning) {
        add({name, "", meaning, &value, anything(), choices, {}});
    }
    /// Free text, such as the path of a file.
    /// note:   without control characters and at most 900 letters, so that a case can hold it.
    void text(const std::string& name, std::string& value, const std::string& meaning) {
        choice(name, value, {}, meaning);
    }

    /// Named sub-tables: [name.item] appends an Item whose member `name` is "item", and describe()
    /// binds its fields to parameters that begin with the prefix "name.item".
    template <class Item>
    void list(const std::string& name, std::vector<Item>& items,
              void (*describe)(ParameterTable&, const std::string& prefix, Item&),
              const std::string& meaning) {
        items.reserve(most_items);  // the table points into it
        lists_.push_back({name,
                          meaning,
                          [this, name, &items, describe](const std::string& item) {
                              items.emplace_back();
                              items.back().name = item;
                              describe(*this, name + "." + item, items.back());
                          },
                          {},
                          {}});
        Item pattern;
        pattern_ = &lists_.back().pattern;
        describe(*this, name + ".<name>", pattern);
        pattern_ = nullptr;
    }

    /// Names, or beginnings that end in '.', that a restart may give another value.
    void may_change_on_restart(const std::vector<std::string>& names) { changeable_ = names; }
    bool is_changeable(const std::string& name) const;

    /// Pairs of an earlier name, or the beginning of earlier names that ends in '.', and its new
    /// one: set() refuses the earlier name with the new one. The first pair that fits counts.
    void renamed(const std::vector<std::pair<std::string, std::string>>& names) {
        renamed_ = names;
    }

    /// Whether a parameter takes this value as text, without quotes; nothing where set() refuses its name.
    std::optional<bool> takes_text(const std::string& name, const std::string& value = "");

    /// Gives a parameter its value.
    /// errors: InputError for a wrong name, type or value, with the place and the cure.
    void set(const Setting& setting);

    /// All parameters with unit, range and default, under their headings.
    std::string help() const;

    /// Sets what follows from other parameters, before anything compares cases.
    std::function<void()> derive = [] {};

    /// Complete TOML text of all values.
    /// exact:  reading it gives the same values and the same text.
    std::string effective_case() const;

    /// What the case exists to show; describe_expectation() gives it the parameters expect.fails and
    /// expect.because.
    Expectation expectation;
    void describe_expectation();

   private:
    static constexpr std::size_t most_items = 256;
    static constexpr std::size_t longest_text = 900;  // escaped, it still fits a line of a case
    struct Entry {
        std::string name, unit, meaning;
        std::variant<bool*, long*, double*, std::string*, Formula*, std::optional<double>*> target;
        Range allowed;
        std::vector<std::string> choices;
        std::string initial;  // the default, as text
    };
    struct Group {
        std::string title;
        std::vector<std::size_t> entries;
    };
    struct List {
        std::string name, meaning;
        std::function<void(const std::string&)> append;
        std::vector<std::string> items;
        std::vector<Entry> pattern;
    };

    void add(Entry entry);
    Entry* find(const std::string& name);
    void make_item(const Setting& setting);
    void accept_empty_section(const Setting& setting);
    std::string nearest(const std::string& name) const;
    std::string in_nearest_list(const std::string& name) const;
    std::string new_name(const std::string& name) const;

    std::vector<Entry> entries_;
    std::vector<Group> groups_;
    std::vector<List> lists_;
    std::vector<Entry>* pattern_ = nullptr;  // where entries go while a list's pattern is described
    std::vector<std::string> changeable_;
    std::vector<std::pair<std::string, std::string>> renamed_;
};

/// What a program says about itself.
struct ProgramInfo {
    std::string program, version, one_line;
    std::string default_case;  // relative to the project's root
};

/// What the command line said, besides parameters.
struct CommandLine {
    std::string program;               // as it was called
    std::string case_path, case_name;  // the file, and its name without ending
    std::string out_dir;               // --out, or out/<program>/<case name>
    std::string restart_path;          // "" without --restart
    long restart_step = 0;             // the step of that checkpoint
    int threads = 0;                   // 0: as many as there are cores to use
    int refine = 0;                    // on how many meshes the case is run; 0: no --refine
    bool dry_run = false, quiet = false, force = false, strict = false;
    bool resume = false;      // go on with the run in the folder, if it is of this case
    bool complete = false;    // and that run has nothing left to do
    bool fell_short = false;  // and one of its results is a FAIL
};

/// Reads case file and overrides into the table. --help and --version print and end the program, and
/// --refine runs it on one mesh after the other and ends it. With --restart the case is the one stored
/// in the checkpoint, and only parameters that may change can be overridden with another value.
/// errors: InputError with the place and the cure; nothing has been written then.
CommandLine read_command_line(int argc, char** argv, const ProgramInfo& info,
                              ParameterTable& table);

/// The settings in the text of a case file, in order.
/// errors: InputError with source:line:column.
std::vector<Setting> read_case(const std::string& text, const std::string& source);

/// Length of the valid UTF-8 sequence that begins at text[k]; 0 when there is none.
std::size_t utf8_length(std::string_view text, std::size_t k);

/// Shortest text that reads back as the same number.
std::string number_text(double value);

/// Text of a number for messages, four digits.
std::string format(double value);

/// errors: InputError where there is no regular file of this name
void refuse_unreadable(const std::string& path);

/// Whole content of a regular file. errors: InputError that says why it cannot be read.
std::string read_file(const std::string& path);

}  // namespace common
