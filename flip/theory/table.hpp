// Published numbers in files: text with commas, comments after '#', the names of the columns first.
#pragma once

#include <charconv>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "common/run/parameters.hpp"

namespace flip::theory {

/// Reads the columns of a file, such as flip/data/ghia_re100.csv.
/// out:   by name; all of one length
/// errors: InputError for a file that cannot be read, for text that is no number, and for lines of
///         different lengths.
inline std::map<std::string, std::vector<double>> read_table(const std::string& path) {
    std::ifstream file(path);
    if (!file) throw common::InputError(path + ": cannot be read; start in the project's root");
    std::map<std::string, std::vector<double>> columns;
    std::vector<std::string> names;
    for (std::string line; std::getline(file, line);) {
        if (line.empty() || line[0] == '#') continue;
        std::vector<std::string> cells{""};
        for (const char letter : line) {
            if (letter == ',')
                cells.emplace_back();
            else
                cells.back() += letter;
        }
        if (names.empty()) {
            names = cells;
            continue;
        }
        if (cells.size() != names.size())
            throw common::InputError(path + ": '" + line + "' has not one number for each column");
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const char *begin = cells[i].data(), *end = begin + cells[i].size();
            double value = 0.0;
            const auto result = std::from_chars(begin, end, value);
            if (result.ec != std::errc() || result.ptr != end)
                throw common::InputError(path + ": '" + cells[i] + "' is no number");
            columns[names[i]].push_back(value);
        }
    }
    return columns;
}

}  // namespace flip::theory
