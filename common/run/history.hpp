// One row per step, in columns for gnuplot: history.dat, and the same numbers in memory.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <complex>
#include <cstdio>
#include <span>
#include <string>
#include <vector>

#include "common/run/output_file.hpp"
#include "common/run/sentence.hpp"

namespace common {

/// A column of the history: its name and the unit it is given in ("1" for a pure number).
struct Column {
    std::string name, unit;
    bool operator==(const Column&) const = default;
};

/// One row of the history: each quantity's name, unit and value in one place.
struct Row {
    std::vector<Column> columns;
    std::vector<double> values;
    /// Adds a column on the right.
    void add(const std::string& name, const std::string& unit, double value) {
        columns.push_back({name, unit});
        values.push_back(value);
    }
    /// Adds two columns, name_re and name_im.
    void add(const std::string& name, const std::string& unit, std::complex<double> value) {
        add(name + "_re", unit, value.real());
        add(name + "_im", unit, value.imag());
    }
};

class History {
   public:
    /// Nothing is written before the first row.
    explicit History(const std::string& path) : path_(path) {}
    History(const History&) = delete;
    History& operator=(const History&) = delete;
    ~History() {
        if (file_ != nullptr) std::fclose(file_);
    }

    /// Names the columns, once, before the first row, as those of a row whose values do not count:
    /// names_and_units() begins the file.
    void columns(const Row& row) { columns_ = row.columns; }

    /// Adds a row.
    /// errors: NumericalError for a number that is not finite; InputError when the disk is full.
    void row(std::span<const double> values) {
        if (values.size() != columns_.size())
            throw std::logic_error("history: a row of the wrong length");
        for (std::size_t k = 0; k < values.size(); ++k)
            if (!std::isfinite(values[k]))
                fail("'", columns_[k].name, "' is not finite in the row after ", columns_[0].name,
                     " = ",
                     values_.empty() ? "(no row yet)"
                                     : number_text(*(values_.end() - long(columns_.size()))));
        if (file_ == nullptr) open();
        values_.insert(values_.end(), values.begin(), values.end());
        write(values);
        const auto now = std::chrono::steady_clock::now();
        if (now - flushed_ > std::chrono::seconds(1)) flush();
    }

    /// The same from a row that also names its quantities.
    void row(const Row& row) {
        if (row.columns != columns_) throw std::logic_error("history: a row of other columns");
        this->row(row.values);
    }

    /// The first value of a column. errors: logic_error for a name that is not a column, or no row.
    double first(const std::string& name) const { return values_.at(index_of(name)); }

    /// Everything recorded so far in one column.
    /// errors: logic_error for a name that is not a column.
    std::vector<double> column(const std::string& name) const {
        std::vector<double> result;
        for (std::size_t n = index_of(name); n < values_.size(); n += columns_.size())
            result.push_back(values_[n]);
        return result;
    }

    /// The columns name_re and name_im.
    std::vector<std::complex<double>> complex_column(const std::string& name) const {
        const std::vector<double> re = column(name + "_re"), im = column(name + "_im");
        std::vector<std::complex<double>> result;
        for (std::size_t n = 0; n < re.size(); ++n) result.emplace_back(re[n], im[n]);
        return result;
    }

    /// Largest magnitude in a column; 0 without a row.
    double largest(const std::string& name) const {
        double most = 0;
        for (const double value : column(name)) most = std::max(most, std::fabs(value));
        return most;
    }

    /// Sends what is buffered to the file. errors: InputError when the disk is full.
    void flush() {
        if (file_ != nullptr && (std::fflush(file_) != 0 || std::ferror(file_) != 0))
            throw InputError(path_ + ": cannot be written; is the disk full?");
        flushed_ = std::chrono::steady_clock::now();
    }

    long rows() const { return long(values_.size() / columns_.size()); }
    /// All rows, for a checkpoint.
    const std::vector<double>& all() const { return values_; }
    /// Takes the rows of a checkpoint. errors: InputError for other columns or times that fall
    void restore(const std::vector<double>& values) {
        bool rows = !columns_.empty() && !values.empty() && values.size() % columns_.size() == 0;
        for (std::size_t n = columns_.size(); rows && n < values.size(); n += columns_.size())
            rows = values[n] > values[n - columns_.size()];
        if (!rows) throw InputError("its history is damaged, or of another build of the program");
        values_ = values;
    }
    /// Writes the file anew with all rows so far: the same bytes, for rows that were restored.
    void open() {
        file_ = open_for_writing(path_);
        std::fputs(names_and_units(columns_).c_str(), file_);
        for (std::size_t n = 0; n < values_.size(); n += columns_.size())
            write(std::span(values_).subspan(n, columns_.size()));
        flush();
    }

   private:
    std::size_t index_of(const std::string& name) const {
        const auto found = std::ranges::find(columns_, name, &Column::name);
        if (found != columns_.end()) return std::size_t(found - columns_.begin());
        throw std::logic_error("history: no column '" + name + "'");
    }
    void write(std::span<const double> values) {
        std::string line;
        for (const double value : values)
            line.append(line.empty() ? "" : " ").append(number_text(value));
        line += "\n";
        if (std::fputs(line.c_str(), file_) < 0)
            throw InputError(path_ + ": cannot be written; is the disk full?");
    }

    std::string path_;
    std::FILE* file_ = nullptr;
    std::vector<Column> columns_;
    std::vector<double> values_;  // row by row
    std::chrono::steady_clock::time_point flushed_;
};

/// First time at which a column reaches a level from below, linear between rows; NaN when it never
/// does.
inline double time_at_level(const std::vector<double>& times, const std::vector<double>& values,
                            double level) {
    for (std::size_t n = 1; n < times.size(); ++n) {
        if (values[n] >= level && values[n - 1] < level) {
            return times[n - 1] + (level - values[n - 1]) / (values[n] - values[n - 1]) *
                                      (times[n] - times[n - 1]);
        }
    }
    return std::nan("");
}

/// Slope of the straight line of least squares; 0 for fewer than two different times.
inline double slope(std::span<const double> times, std::span<const double> values) {
    const double count = double(times.size());
    double t = 0, y = 0, along = 0, product = 0;
    for (std::size_t n = 0; n < times.size(); ++n) t += times[n] / count, y += values[n] / count;
    for (std::size_t n = 0; n < times.size(); ++n)
        along += (times[n] - t) * (times[n] - t), product += (times[n] - t) * (values[n] - y);
    return along > 0 ? product / along : 0;
}

}  // namespace common
