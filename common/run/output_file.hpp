// A text or binary file that is there whole or not at all.
#pragma once

#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

#include "common/ranks.hpp"
#include "common/run/parameters.hpp"

namespace common {

/// errors: InputError where something is there that is neither a regular file nor nothing: a link, a
///         folder, a device
void refuse_special_file(const std::string& path);

/// Opens a regular file, empty, and never what a symbolic link points at; a rank that does not write
/// for all gets the null device.
/// errors: InputError that says why it cannot be written
std::FILE* open_for_writing(const std::string& path);

/// What snapshots are written as besides text: VTK files for ParaView, HDF5 after openPMD.
struct FileFormats {
    bool vtk = false, openpmd = false;
};

/// Whether the program can write HDF5 files: it was built where the library is.
bool has_openpmd();
/// errors: InputError where a format is asked for that the program cannot write
inline void require_formats(const FileFormats& formats) {
    if (formats.openpmd && !has_openpmd())
        throw InputError(
            "output.openpmd = true, but the program was built without HDF5: install its headers "
            "(libhdf5-dev on Debian) and build again");
}

/// A file that appears under its name only when finish() has been called and everything is written.
class OutputFile {
   public:
    /// Opens path.partial. errors: InputError where it cannot be created.
    explicit OutputFile(const std::string& path) : path_(path), partial_(path + ".partial") {
        refuse_special_file(path_);
        file_ = open_for_writing(partial_);
    }
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;
    ~OutputFile() {
        if (file_ != nullptr) std::fclose(file_);
        if (!finished_ && is_first_rank()) std::remove(partial_.c_str());
    }

    /// Writes words as they are.
    void text(std::string_view words) {
        buffer_ += words;
        if (buffer_.size() > 1 << 16) flush();
    }
    /// Writes the shortest text that reads back as the same number.
    template <class Number>
    void number(Number value) {
        char digits[32];
        const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
        text({digits, std::size_t(end - digits)});
    }

    /// Writes bytes as they are, without a copy.
    void bytes(const void* from, std::size_t count) {
        flush();
        write(from, count);
    }

    /// Gives the file its name. errors: InputError where the disk is full.
    /// in: on_disk, whether its bytes are to be on the disk before it has this name
    void finish(bool on_disk = false) {
        flush();
        if (on_disk && is_first_rank() && (std::fflush(file_) != 0 || fsync(fileno(file_)) != 0))
            fail("cannot be written");
        if (std::fclose(std::exchange(file_, nullptr)) != 0) fail("cannot be written");
        if (is_first_rank() && std::rename(partial_.c_str(), path_.c_str()) != 0)
            fail("cannot be renamed into place");
        finished_ = true;
    }

   private:
    void write(const void* from, std::size_t count) {
        if (count > 0 && std::fwrite(from, 1, count, file_) != count) fail("cannot be written");
    }
    void flush() {
        write(buffer_.data(), buffer_.size());
        buffer_.clear();
    }
    [[noreturn]] void fail(const std::string& what) const {
        throw InputError(path_ + ": " + what + " (" + std::strerror(errno) + ")");
    }

    std::string path_, partial_, buffer_;
    std::FILE* file_ = nullptr;
    bool finished_ = false;
};

/// The first two lines of a table. The first has the names alone, as gnuplot and pandas read them;
/// the second is a comment, "# units: time 1/omega_p, x d_i", without pure numbers.
/// in: columns, which have a name and a unit ("" or "1" for a pure number)
template <class Columns>
std::string names_and_units(const Columns& columns) {
    std::string names, units;
    for (const auto& column : columns) {
        names.append(names.empty() ? "" : " ").append(column.name);
        if (column.unit.empty() || column.unit == "1") continue;
        units.append(units.empty() ? " " : ", ").append(column.name).append(" " + column.unit);
    }
    return names + "\n# units:" + (units.empty() ? " none" : units) + "\n";
}

}  // namespace common
