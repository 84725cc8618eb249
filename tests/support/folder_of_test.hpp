// Where a test keeps its files.
#pragma once

#include <doctest/doctest.h>

#include <filesystem>
#include <functional>
#include <string>

namespace facts {

/// A folder that belongs to the current test alone: tests run side by side.
inline std::string folder_of_test() {
    const doctest::detail::TestCase* test = doctest::getContextOptions()->currentTest;
    const std::string file = std::filesystem::path(test->m_file.c_str()).stem().string();
    return std::string(BUILD_FOLDER) + "/tests/runs/" + file + "/" +
           std::to_string(std::hash<std::string>{}(test->m_name));
}

}  // namespace facts
