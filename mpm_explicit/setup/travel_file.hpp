// The travel of a rigid grain as a text file that a person can write, one time per line:
//     time  travel_x [travel_y]
// Only differences count: a grain starts where its case puts it. A line may be empty, and '#' begins
// a comment.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "mpm_explicit/grains/grains.hpp"
#include "mpm_explicit/setup/pack_file.hpp"

namespace mpm {

/// Reads the travel of a rigid grain.
/// errors: InputError with file and line for what is no travel: other than two or three numbers in
///         a line, or times that do not rise
inline std::vector<TravelRow> read_travel(const std::string& path) {
    std::vector<TravelRow> rows;
    std::size_t columns = 0;
    detail::for_each_line(path, [&](const auto& words, const std::string& place) {
        if (columns == 0 && words.size() == 3) columns = 3;
        if (columns == 0) columns = 2;
        require(words.size() == columns, place + ": " + std::to_string(words.size()) +
                                             " numbers for a time and a travel " +
                                             (columns == 2 ? "along x" : "along x and y") +
                                             ": write " + std::to_string(columns));
        TravelRow row;
        row.t = detail::read_number(words[0], place), row.x = detail::read_number(words[1], place);
        if (columns == 3) row.y = detail::read_number(words[2], place);
        require(rows.empty() || row.t > rows.back().t,
                place + ": the time " + detail::in_quotes(words[0]) +
                    " is not after that of the line before: sort the lines by time");
        rows.push_back(row);
    });
    require(
        rows.size() > 1,
        path + ": holds no travel; write two lines or more like: 0.5 1e-3, a time and a travel");
    return rows;
}

/// The largest speed of a travel.
inline double fastest(const std::vector<TravelRow>& rows) {
    double v = 0;
    for (std::size_t k = 1; k < rows.size(); ++k)
        v = std::max(v, std::hypot(rows[k].x - rows[k - 1].x, rows[k].y - rows[k - 1].y) /
                            (rows[k].t - rows[k - 1].t));
    return v;
}

}  // namespace mpm
