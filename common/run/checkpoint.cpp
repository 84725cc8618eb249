#include "common/run/checkpoint.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#define XXH_INLINE_ALL 1
#include <xxhash.h>

#include "common/run/sentence.hpp"

namespace common {

constexpr char magic[] = "PICSTAT2", end_of_file[] = "end";

CheckpointWriter::CheckpointWriter(const ProgramInfo& info, const std::string& path,
                                   const std::string& case_name, const std::string& effective_case)
    : file_(path), path_(path) {
    write(magic, 8);
    (*this)("program", info.program);
    (*this)("version", info.version);
    (*this)("case_name", case_name);
    (*this)("case", effective_case);
}

void CheckpointWriter::write(const void* from, std::size_t bytes) {
    file_.bytes(from, bytes);
    checksum_ = XXH3_64bits_withSeed(from, bytes, checksum_);
}

void CheckpointWriter::write_block(const std::string& name, char type, const void* from,
                                   std::size_t count, std::size_t size, std::size_t all) {
    const std::uint64_t letters = name.size(), numbers = all > 0 ? all : count;
    write(&letters, sizeof letters);
    write(name.data(), name.size());
    write(&type, 1);
    write(&numbers, sizeof numbers);
    if (all == 0) {
        write(from, count * size);
    } else {
        // The checksum of a block is that of its numbers in one piece.
        XXH3_state_t state;
        XXH3_64bits_reset_withSeed(&state, checksum_);
        gather_in_turn(from, count * size, [&](const void* piece, std::size_t bytes) {
            file_.bytes(piece, bytes);
            XXH3_64bits_update(&state, piece, bytes);
        });
        checksum_ = XXH3_64bits_digest(&state);
    }
    const std::uint64_t sum = checksum_;
    write(&sum, sizeof sum);
}

void CheckpointWriter::finish() {
    (*this)(end_of_file, std::string());
    file_.finish(true);
    if (!is_first_rank()) return;
    // The new name is on the disk when the folder is.
    const std::string folder = std::filesystem::path(path_).parent_path().string();
    const int directory =
        open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (directory >= 0) fsync(directory), close(directory);
}

CheckpointReader::CheckpointReader(const ProgramInfo& info, const std::string& path) : path_(path) {
    refuse_unreadable(path);
    file_.reset(std::fopen(path.c_str(), "rbe"), [](std::FILE* file) {
        if (file != nullptr) std::fclose(file);
    });
    struct stat status {};
    if (file_ == nullptr || fstat(fileno(file_.get()), &status) != 0)
        throw InputError(path + ": cannot be read: " + std::strerror(errno));
    left_ = std::uint64_t(status.st_size);

    char found[8] = {};
    if (left_ >= 8) read(found, 8);
    const std::string cure = "; continue it with the program that wrote it";
    common::refuse(std::memcmp(found, "PICSTATE", 8) == 0, path,
                   ": was written by an earlier version of the program", cure);
    common::refuse(std::memcmp(found, magic, 8) != 0, path, ": is not a checkpoint");
    blocks_ = verify();
    const std::string program = text("program"), version = text("version");
    common::refuse(program != info.program, path, ": is a checkpoint of '", program, "', not of '",
                   info.program, "'");
    common::refuse(version != info.version, path, ": was written by version ", version,
                   ", and this is ", info.version, cure);
    case_name_ = text("case_name");
    effective_case_ = text("case");
}

void CheckpointReader::refuse(const std::string& why) const {
    throw InputError(path_ + ": the checkpoint " + why + "; use an earlier one");
}

void CheckpointReader::read_plain(void* to, std::size_t bytes) {
    if (bytes > left_) refuse("is cut off or too long");
    if (bytes > 0 && std::fread(to, 1, bytes, file_.get()) != bytes)
        throw InputError(path_ + ": cannot be read: " + std::strerror(errno));
    left_ -= bytes;
}

void CheckpointReader::read(void* to, std::size_t bytes) {
    read_plain(to, bytes);
    checksum_ = XXH3_64bits_withSeed(to, bytes, checksum_);
}

CheckpointReader::Header CheckpointReader::read_header() {
    constexpr std::uint64_t longest_name = 4096;
    std::uint64_t letters = 0, count = 0;
    char type = 0;
    read(&letters, sizeof letters);
    if (letters > longest_name) refuse("is damaged");
    std::string name(letters, '\0');
    read(name.data(), name.size());
    read(&type, 1);
    read(&count, sizeof count);
    return {name, type, count};
}

void CheckpointReader::check_sum() {
    const std::uint64_t expected = checksum_;
    std::uint64_t found = 0;
    read(&found, sizeof found);
    if (found != expected) refuse("is damaged (its checksum is wrong)");
}

void CheckpointReader::read_in_pieces(std::uint64_t bytes,
                                      const std::function<void(const void*, std::size_t)>& take) {
    // The checksum of a block is that of its numbers in one piece.
    XXH3_state_t state;
    XXH3_64bits_reset_withSeed(&state, checksum_);
    std::vector<char> piece(std::min<std::uint64_t>(bytes, 1 << 20));
    while (bytes > 0) {
        const std::size_t part = std::min<std::uint64_t>(bytes, piece.size());
        read_plain(piece.data(), part);
        XXH3_64bits_update(&state, piece.data(), part);
        take(piece.data(), part);
        bytes -= part;
    }
    checksum_ = XXH3_64bits_digest(&state);
    check_sum();
}

std::size_t CheckpointReader::begin_block(const std::string& name, char type, std::size_t size) {
    const Header header = read_header();
    if (header.name == end_of_file && name != end_of_file) refuse("ends too early");
    common::refuse(header.name != name || header.type != type, path_, ": holds '", header.name,
                   "' where '", name, "' is expected; another build wrote it");
    if (header.count > left_ / size) refuse("is cut off or too long");
    return header.count;
}

void CheckpointReader::require_length(const std::string& name, std::size_t found,
                                      std::size_t wanted) const {
    common::refuse(found != wanted, path_, ": '", name, "' has ", found, " values where ", wanted,
                   " are expected; another build wrote it");
}

std::string CheckpointReader::text(const std::string& name) {
    std::string text(begin_block(name, 'c', 1), '\0');
    end_block(name, text.data(), text.size());
    return text;
}

void CheckpointReader::finish() {
    text(end_of_file);
    if (left_ > 0) refuse("is cut off or too long");
}

long CheckpointReader::verify() {
    const long begin = std::ftell(file_.get());
    const std::uint64_t left = left_, checksum = checksum_;
    long blocks = 0;
    for (bool more = true; more; ++blocks) {
        const Header header = read_header();
        const std::string types = "dflic";
        const std::size_t sizes[] = {8, 4, 8, 4, 1}, kind = types.find(header.type);
        if (kind == std::string::npos || header.count > left_ / sizes[kind]) refuse("is damaged");
        read_in_pieces(header.count * sizes[kind], [](const void*, std::size_t) {});
        more = header.name != end_of_file;
    }
    if (left_ > 0) refuse("is cut off or too long");
    if (std::fseek(file_.get(), begin, SEEK_SET) != 0)
        throw InputError(path_ + ": cannot be read: " + std::strerror(errno));
    left_ = left;
    checksum_ = checksum;
    return blocks;
}

}  // namespace common
