#include "common/run/output_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

namespace common {

void refuse_special_file(const std::string& path) {
    if (!is_first_rank()) return;
    std::error_code ignored;
    const auto status = std::filesystem::symlink_status(path, ignored);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
        throw InputError(path + ": is not a regular file; remove it or write elsewhere");
}

std::FILE* open_for_writing(const std::string& path) {
    if (!is_first_rank()) return std::fopen("/dev/null", "wb");
    refuse_special_file(path);
    // What has come into its place since is refused as well: a link, or a pipe without a reader.
    const int file =
        open(path.c_str(), O_WRONLY | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
    struct stat status {};
    std::FILE* stream = nullptr;
    if (file >= 0 && fstat(file, &status) == 0 && S_ISREG(status.st_mode) &&
        ftruncate(file, 0) == 0)
        stream = fdopen(file, "wb");
    if (stream == nullptr) {
        const std::string reason = std::strerror(errno);
        if (file >= 0) close(file);
        // What has just been made for nothing goes.
        if (S_ISREG(status.st_mode) && status.st_size == 0) unlink(path.c_str());
        throw InputError(path + ": cannot be opened for writing (" + reason + ")");
    }
    return stream;
}

}  // namespace common
