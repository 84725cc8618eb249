// The whole state of a run in one file, to continue from later with the same bits.
//
//   "PICSTATE" | length of the rest | program, version, case | named blocks ... | checksum of all
//   before
//
// A block is a name, a letter for its type, a count and the numbers as they are in memory.
#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <Eigen/Core>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "common/run/parameters.hpp"

namespace common {

namespace checkpoint_detail {

inline constexpr char magic[] = "PICSTATE";

/// FNV-1a over words of eight bytes. exact: a single changed bit always changes it.
inline std::uint64_t checksum(std::span<const char> bytes) {
    std::uint64_t sum = 0xcbf29ce484222325U;
    for (std::size_t k = 0; k < bytes.size(); k += 8) {
        std::uint64_t word = 0;
        std::memcpy(&word, bytes.data() + k, std::min<std::size_t>(8, bytes.size() - k));
        sum = (sum ^ word) * 0x100000001b3U;
    }
    return sum;
}

/// The letter that stands for a type of number in a file.
template <class Number>
constexpr char letter_of() {
    if constexpr (std::is_same_v<Number, double>) return 'd';
    if constexpr (std::is_same_v<Number, float>) return 'f';
    if constexpr (std::is_same_v<Number, long>) return 'l';
    if constexpr (std::is_same_v<Number, int>) return 'i';
}

}  // namespace checkpoint_detail

/// An archive that collects named numbers; write() puts them into a file.
class CheckpointWriter {
   public:
    CheckpointWriter(const ProgramInfo& info, const std::string& effective_case) {
        put(checkpoint_detail::magic, 8);
        put_number(0);  // the length, known later
        put_text(info.program);
        put_text(info.version);
        put_text(effective_case);
    }

    /// Adds one number.
    template <class Number>
    void operator()(const std::string& name, const Number& value) {
        block(name, &value, 1);
    }
    /// Adds a list of numbers.
    template <class Number>
    void operator()(const std::string& name, const std::vector<Number>& values) {
        block(name, values.data(), values.size());
    }
    /// Adds a list of numbers.
    void operator()(const std::string& name, const Eigen::VectorXd& values) {
        block(name, values.data(), static_cast<std::size_t>(values.size()));
    }

    /// Writes beside `path`, flushes to the disk, then renames: `path` is the old file or the whole
    /// new one.
    /// errors: InputError when the target is not a regular file, or the disk is full; the old file
    ///         is intact.
    void write(const std::string& path) {
        struct stat target {};
        if (lstat(path.c_str(), &target) == 0 && !S_ISREG(target.st_mode)) {
            throw InputError(
                path + ": is there and is not a regular file; the checkpoint will not replace it");
        }
        const std::uint64_t length = bytes_.size() - 16;
        std::memcpy(bytes_.data() + 8, &length, 8);
        const std::uint64_t sum = checkpoint_detail::checksum(bytes_);

        const std::string partial = path + ".partial";
        const int file = open(partial.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
        const auto fail = [&](const char* what) {
            const std::string reason = std::strerror(errno);
            if (file >= 0) close(file);
            unlink(partial.c_str());
            throw InputError(partial + ": cannot " + what + " the checkpoint: " + reason);
        };
        if (file < 0) fail("create");
        const auto write_all = [&](const char* from, std::size_t count) {
            while (count > 0) {
                const ssize_t done = ::write(file, from, count);
                if (done < 0 && errno == EINTR) continue;
                if (done <= 0) fail("write");
                from += done;
                count -= static_cast<std::size_t>(done);
            }
        };
        write_all(bytes_.data(), bytes_.size());
        write_all(reinterpret_cast<const char*>(&sum), sizeof sum);
        if (fsync(file) != 0) fail("flush");
        if (close(file) != 0 || rename(partial.c_str(), path.c_str()) != 0) fail("finish");
        const std::string folder = std::filesystem::path(path).parent_path().string();
        const int directory =
            open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        if (directory >= 0) {
            fsync(directory);
            close(directory);
        }
    }

   private:
    void put(const void* from, std::size_t count) {
        const auto* bytes = static_cast<const char*>(from);
        bytes_.insert(bytes_.end(), bytes, bytes + count);
    }
    void put_number(std::uint64_t number) { put(&number, sizeof number); }
    void put_text(const std::string& text) {
        put_number(text.size());
        put(text.data(), text.size());
    }
    template <class Number>
    void block(const std::string& name, const Number* from, std::size_t count) {
        const char type = checkpoint_detail::letter_of<Number>();
        put_text(name);
        put(&type, 1);
        put_number(count);
        put(from, count * sizeof(Number));
    }

    std::vector<char> bytes_;
};

/// An archive that gives back what a CheckpointWriter wrote, in the same order.
/// errors: InputError for a file that is damaged, cut off, foreign, or of another program or
///         version.
class CheckpointReader {
   public:
    CheckpointReader(const ProgramInfo& info, const std::string& path)
        : path_(path), bytes_(read_file(path)) {
        if (bytes_.size() < 24 || std::memcmp(bytes_.data(), checkpoint_detail::magic, 8) != 0) {
            throw InputError(path + ": is not a checkpoint");
        }
        at_ = 8;
        if (number() != bytes_.size() - 24)
            throw InputError(path + ": the checkpoint is cut off or too long; use an earlier one");
        std::uint64_t sum = 0;
        std::memcpy(&sum, bytes_.data() + bytes_.size() - 8, 8);
        if (sum != checkpoint_detail::checksum(std::span(bytes_.data(), bytes_.size() - 8))) {
            throw InputError(
                path + ": the checkpoint is damaged (its checksum is wrong); use an earlier one");
        }
        const std::string program = text(), version = text();
        if (program != info.program) {
            throw InputError(path + ": is a checkpoint of '" + program + "', not of '" +
                             info.program + "'");
        }
        if (version != info.version) {
            throw InputError(path + ": was written by version " + version + ", and this is " +
                             info.version + "; continue it with the program that wrote it");
        }
        effective_case_ = text();
    }

    /// The complete input of the run that wrote the file, as TOML.
    const std::string& effective_case() const { return effective_case_; }

    /// Reads one number.
    template <class Number>
    void operator()(const std::string& name, Number& value) {
        block(name, &value, 1);
    }
    /// Reads a list of numbers of any length.
    template <class Number>
    void operator()(const std::string& name, std::vector<Number>& values) {
        values.resize(count<Number>(name));
        copy(values.data(), values.size() * sizeof(Number));
    }
    /// Reads a list of numbers whose length is known.
    void operator()(const std::string& name, Eigen::VectorXd& values) {
        block(name, values.data(), static_cast<std::size_t>(values.size()));
    }

   private:
    void copy(void* to, std::size_t count) {
        if (at_ + count > bytes_.size() - 8)
            throw InputError(path_ + ": the checkpoint ends too early; use an earlier one");
        if (count > 0) std::memcpy(to, bytes_.data() + at_, count);
        at_ += count;
    }
    std::uint64_t number() {
        std::uint64_t value = 0;
        copy(&value, sizeof value);
        return value;
    }
    std::string text() {
        std::string value(std::min<std::uint64_t>(number(), bytes_.size()), '\0');
        copy(value.data(), value.size());
        return value;
    }
    // Length of the next block, which must have this name and type.
    template <class Number>
    std::size_t count(const std::string& name) {
        const std::string found = text();
        char found_type = 0;
        copy(&found_type, 1);
        const std::size_t length = number();
        if (found != name || found_type != checkpoint_detail::letter_of<Number>() ||
            length > bytes_.size() / sizeof(Number)) {
            throw InputError(path_ + ": holds '" + found + "' where '" + name +
                             "' is expected; it belongs to another case");
        }
        return length;
    }
    template <class Number>
    void block(const std::string& name, Number* to, std::size_t length) {
        const std::size_t found = count<Number>(name);
        if (found != length) {
            throw InputError(path_ + ": '" + name + "' has " + std::to_string(found) +
                             " values where " + std::to_string(length) +
                             " are expected; it belongs to another case");
        }
        copy(to, length * sizeof(Number));
    }

    std::string path_, bytes_;
    std::size_t at_ = 0;
    std::string effective_case_;
};

}  // namespace common
