// The whole state of a run in one file, to continue from later with the same bits.
//
//   "PICSTAT2" | program, version, name of the case, case | named blocks ... | end
//
// Each of these is a block:  name | letter for its type | count | numbers as in memory | checksum.
// A checksum covers its block and the checksum before, so that no block can be changed, taken out
// or put elsewhere. Blocks go to the disk and come from it one by one: no copy of the state is made.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "common/ranks.hpp"
#include "common/run/output_file.hpp"

namespace common {

/// The letter that stands for a type of number in a checkpoint.
template <class Number>
constexpr char letter_of() {
    if constexpr (std::is_same_v<Number, double>) return 'd';
    if constexpr (std::is_same_v<Number, float>) return 'f';
    if constexpr (std::is_same_v<Number, long>) return 'l';
    if constexpr (std::is_same_v<Number, int>) return 'i';
    if constexpr (std::is_same_v<Number, char>) return 'c';
}

/// Whether all numbers of a list lie in [low, high]; what is not a number does not.
template <class Numbers>
bool all_within(const Numbers& values, double low, double high) {
    return std::ranges::all_of(values, [=](double x) { return x >= low && x <= high; });
}

/// An archive that writes named numbers into a file beside `path`; finish() gives it that name.
/// errors: InputError when the target is not a regular file, or the disk is full; an earlier file
///         of this name is intact then, and nothing else is left.
class CheckpointWriter {
   public:
    /// Opens the file and writes what it is a checkpoint of.
    CheckpointWriter(const ProgramInfo& info, const std::string& path, const std::string& case_name,
                     const std::string& effective_case);

    /// Adds one number.
    template <class Number>
    requires std::is_arithmetic_v<Number>
    void operator()(const std::string& name, const Number& value) { block(name, &value, 1); }
    /// Adds a text or a list of numbers: std::vector or a dense vector of Eigen.
    template <class Numbers>
    requires(!std::is_arithmetic_v<Numbers>) void operator()(const std::string& name,
                                                             const Numbers& values) {
        block(name, values.data(), std::size_t(values.size()));
    }
    /// Adds a list of which every rank has a part.
    template <class Number>
    void operator()(const std::string& name, const OfAllRanks<Number>& part) {
        block(name, part.values.data(), part.values.size(),
              std::size_t(sum_over_ranks(std::ssize(part.values))));
    }
    void operator()(const std::string& name, const SumOverRanks& part) {
        std::vector<long> sum(part.values.begin(), part.values.end());
        sum_over_ranks(sum);
        (*this)(name, std::vector<int>(sum.begin(), sum.end()));
    }

    /// Ends the file, flushes it to the disk and renames it: `path` is the old file or the whole new
    /// one at any time.
    void finish();

   private:
    // in: all, the numbers of all ranks where each has some; 0: every rank has all
    template <class Number>
    void block(const std::string& name, const Number* from, std::size_t count,
               std::size_t all = 0) {
        write_block(name, letter_of<Number>(), from, count, sizeof(Number), all);
    }
    void write_block(const std::string& name, char type, const void* from, std::size_t count,
                     std::size_t size, std::size_t all);
    void write(const void* from, std::size_t bytes);

    OutputFile file_;
    std::string path_;
    std::uint64_t checksum_ = 0;
};

/// An archive that gives back what a CheckpointWriter wrote, in the same order.
/// errors: InputError for a file that is damaged, cut off, foreign, or of another program, version
///         or case, or with numbers that are not finite. No more memory is taken than the file has
///         bytes.
class CheckpointReader {
   public:
    /// Opens the file, reads all of it once to see that it is whole, and what it is a checkpoint of.
    CheckpointReader(const ProgramInfo& info, const std::string& path);

    /// The complete input of the run that wrote the file, as TOML.
    const std::string& effective_case() const { return effective_case_; }
    /// The name of its case.
    const std::string& case_name() const { return case_name_; }
    /// How many blocks the file has.
    long blocks() const { return blocks_; }

    /// Reads one number.
    template <class Number>
    requires std::is_arithmetic_v<Number>
    void operator()(const std::string& name, Number& value) { block(name, &value, 1); }
    /// Reads a list of numbers of any length.
    template <class Number>
    void operator()(const std::string& name, std::vector<Number>& values) {
        (*this)(name, OfAllRanks<Number>{values});
    }
    /// The same for a list of which a rank keeps its share.
    template <class Number>
    void operator()(const std::string& name, const OfAllRanks<Number>& part) {
        const long count = long(begin_block(name, letter_of<Number>(), sizeof(Number))),
                   begin = part.share.begin(count), end = part.share.end(count);
        std::vector<Number>().swap(part.values);
        part.values.reserve(std::size_t(end - begin));
        long before = 0;
        read_in_pieces(std::uint64_t(count) * sizeof(Number), [&](const void* piece,
                                                                  std::size_t bytes) {
            const Number* from = static_cast<const Number*>(piece);
            const long numbers = long(bytes / sizeof(Number));
            require_finite(name, from, numbers);
            part.values.insert(part.values.end(), from + std::clamp(begin - before, 0L, numbers),
                               from + std::clamp(end - before, 0L, numbers));
            before += numbers;
        });
    }
    void operator()(const std::string& name, const SumOverRanks& sum) { (*this)(name, sum.values); }
    /// Reads a list of numbers whose length is known: a dense vector of Eigen.
    template <class Numbers>
    requires(!std::is_arithmetic_v<Numbers>) void operator()(const std::string& name, Numbers& v) {
        block(name, v.data(), std::size_t(v.size()));
    }

    /// Nothing may follow. errors: InputError where something does.
    void finish();

   private:
    template <class Number>
    void block(const std::string& name, Number* to, std::size_t length) {
        require_length(name, begin_block(name, letter_of<Number>(), sizeof(Number)), length);
        end_block(name, to, length);
    }
    template <class Number>
    void end_block(const std::string& name, Number* to, std::size_t count) {
        read(to, count * sizeof(Number));
        check_sum();
        require_finite(name, to, long(count));
    }
    template <class Number>
    void require_finite(const std::string& name, const Number* from, long count) {
        if (!std::all_of(from, from + count, [](Number x) { return std::isfinite(double(x)); }))
            refuse("has numbers in '" + name + "' that are not finite");
    }
    struct Header {
        std::string name;
        char type;
        std::size_t count;
    };
    // Reads all blocks without keeping them, and begins again. out: how many there are
    long verify();
    Header read_header();
    std::size_t begin_block(const std::string& name, char type, std::size_t size);
    void check_sum();
    // Reads the numbers of a block, of which take(piece, bytes) gets some at a time, and its checksum.
    void read_in_pieces(std::uint64_t bytes,
                        const std::function<void(const void*, std::size_t)>& take);
    [[noreturn]] void refuse(const std::string& why) const;
    void require_length(const std::string& name, std::size_t found, std::size_t wanted) const;
    std::string text(const std::string& name);
    void read(void* to, std::size_t bytes);
    void read_plain(void* to, std::size_t bytes);

    std::shared_ptr<std::FILE> file_;
    std::string path_, effective_case_, case_name_;
    std::uint64_t left_ = 0;  // bytes of the file that were not read so far
    std::uint64_t checksum_ = 0;
    long blocks_ = 0;
};

}  // namespace common
