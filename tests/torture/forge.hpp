// A checkpoint that is taken apart, changed by lines of text, and put together with checksums that
// are right, so that only what is read can give the change away. Its format stands in
// common/run/checkpoint.hpp.
//
//   number BLOCK K VALUE    the K-th number of a block      length BLOCK COUNT   more or fewer
//   case K VALUE            the value in the K-th line of the case
//   name BLOCK WORD         type BLOCK LETTER               remove BLOCK         repeat BLOCK
//   byte K VALUE            cut LENGTH                      these leave the checksums as they were
//
// A block is given by its name or its place; places are taken modulo what there is.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

#define XXH_INLINE_ALL 1
#include <xxhash.h>

namespace torture {

struct Block {
    std::string name;
    char type;
    std::string bytes;  // its numbers as in memory
};

inline std::size_t size_of(char type) {
    return type == 'c' ? 1 : type == 'f' || type == 'i' ? 4 : 8;
}

/// in: file, a whole checkpoint
inline std::vector<Block> blocks_of(const std::string& file) {
    std::vector<Block> blocks;
    const auto number = [&](std::size_t at) {
        std::uint64_t value = 0;
        std::memcpy(&value, file.data() + at, 8);
        return value;
    };
    for (std::size_t at = 8; at < file.size();) {
        Block block;
        block.name = file.substr(at + 8, number(at));
        at += 8 + block.name.size();
        block.type = file[at];
        block.bytes = file.substr(at + 9, number(at + 1) * size_of(block.type));
        at += 9 + block.bytes.size() + 8;
        blocks.push_back(block);
    }
    return blocks;
}

inline std::string file_of(const std::vector<Block>& blocks) {
    std::string file;
    std::uint64_t checksum = 0;
    const auto write = [&](const void* from, std::size_t bytes) {
        file.append(static_cast<const char*>(from), bytes);
        checksum = XXH3_64bits_withSeed(from, bytes, checksum);
    };
    write("PICSTAT2", 8);
    for (const Block& block : blocks) {
        const std::uint64_t letters = block.name.size(),
                            count = block.bytes.size() / size_of(block.type);
        write(&letters, 8);
        write(block.name.data(), letters);
        write(&block.type, 1);
        write(&count, 8);
        write(block.bytes.data(), count * size_of(block.type));
        const std::uint64_t sum = checksum;
        write(&sum, 8);
    }
    return file;
}

/// Puts a value, in words, where the K-th number of a block is.
inline void put(Block& block, std::size_t k, const std::string& value) {
    const std::size_t size = size_of(block.type), count = block.bytes.size() / size;
    if (count == 0) return;
    char* to = block.bytes.data() + k % count * size;
    const double real = std::strtod(value.c_str(), nullptr);
    const long whole = std::strtol(value.c_str(), nullptr, 10);
    const float small = std::strtof(value.c_str(), nullptr);
    if (block.type == 'd') std::memcpy(to, &real, size);
    if (block.type == 'f') std::memcpy(to, &small, size);
    if (block.type == 'l' || block.type == 'i' || block.type == 'c') std::memcpy(to, &whole, size);
}

/// in: edits, lines as above; what is none of them does nothing
/// out: the bytes of the forged file
inline std::string forged(const std::string& file, const std::string& edits) {
    std::vector<Block> blocks = blocks_of(file);
    std::vector<std::pair<std::size_t, char>> bytes;
    std::size_t cut = std::string::npos;
    std::istringstream lines(edits);
    for (std::string line; std::getline(lines, line) && !blocks.empty();) {
        std::istringstream words(line);
        std::string what, where, first, second;
        words >> what >> where >> first >> second;
        const auto place = [](const std::string& word) {
            return std::size_t(std::strtoull(word.c_str(), nullptr, 10));
        };
        auto block = std::find_if(blocks.begin(), blocks.end(),
                                  [&](const Block& one) { return one.name == where; });
        if (block == blocks.end()) block = blocks.begin() + long(place(where) % blocks.size());
        if (what == "number") put(*block, place(first), second);
        if (what == "length" && !block->bytes.empty()) {
            const std::size_t size = size_of(block->type), old = block->bytes.size();
            block->bytes.resize(std::min<std::size_t>(place(first), 1 << 16) * size);
            for (std::size_t k = old; k < block->bytes.size(); ++k)
                block->bytes[k] = block->bytes[k - old];
        }
        if (what == "name") block->name = first;
        if (what == "type" && !first.empty()) {
            block->type = first[0];
            block->bytes.resize(block->bytes.size() / size_of(block->type) * size_of(block->type));
        }
        if (what == "remove") blocks.erase(block);
        if (what == "repeat") blocks.insert(block, Block(*block));
        if (what == "byte") bytes.emplace_back(place(where), static_cast<char>(place(first)));
        if (what == "cut") cut = place(where);
        if (what != "case" || blocks.size() < 4) continue;
        std::string& text = blocks[3].bytes;
        std::vector<std::size_t> values;
        for (std::size_t at = text.find(" = "); at != std::string::npos;
             at = text.find(" = ", at + 1))
            values.push_back(at + 3);
        if (values.empty()) continue;
        const std::size_t at = values[place(where) % values.size()];
        text.replace(at, text.find('\n', at) - at, first);
    }
    std::string result = file_of(blocks);
    for (const auto& [at, value] : bytes) result[at % result.size()] = value;
    return result.substr(0, cut == std::string::npos ? cut : cut % result.size());
}

}  // namespace torture
