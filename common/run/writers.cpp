// HDF5 files through openpmd.so, which is there where the HDF5 library was when the programs were
// built. It is opened when it is asked for: the library brings forty others along, which would
// triple the memory and the start of every program.
#include "common/run/writers.hpp"

#include <dlfcn.h>

#include <filesystem>

namespace fs = std::filesystem;

namespace common {

namespace {

// A function of openpmd.so, beside the program, above it or in lib/ of an installation; or nothing.
void* function_of_library(const char* name) {
    static void* const library = [] {
        std::error_code error;
        const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
        for (const char* place : {".", "..", "../lib/particle-in-cell"}) {
            const fs::path file = folder / place / "openpmd.so";
            if (void* found = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL)) return found;
        }
        return static_cast<void*>(nullptr);
    }();
    return library != nullptr ? dlsym(library, name) : nullptr;
}

// Calls a function of the library and gives the file its name when it is whole.
template <class... Arguments>
void write_by(const char* name, const Snapshot& at, const std::string& kind,
              const Arguments&... arguments) {
    if (!is_first_rank()) return;
    using Function =
        std::string(const std::string&, const Snapshot&, const std::string&, const Arguments&...);
    const std::string path = at.path(kind, "h5"), partial = path + ".partial";
    refuse_special_file(path);
    std::fclose(open_for_writing(partial));
    const auto function = reinterpret_cast<Function*>(function_of_library(name));
    std::string failure = function != nullptr ? function(partial, at, kind, arguments...)
                                              : "openpmd.so is not there any more";
    std::error_code error;
    if (failure.empty()) fs::rename(partial, path, error);
    if (error) failure = error.message();
    if (failure.empty()) return;
    std::remove(partial.c_str());
    throw InputError(path + ": cannot be written: " + failure);
}

}  // namespace

bool has_openpmd() { return function_of_library("write_openpmd_particles") != nullptr; }

void write_openpmd_mesh(const Snapshot& at, const std::string& kind, const SampledAxis& x,
                        const SampledAxis& z, const std::vector<ScalarColumn>& fields) {
    write_by("write_openpmd_mesh", at, kind, x, z, fields);
}

void write_openpmd_particles(const Snapshot& at, const std::string& kind,
                             const std::vector<ScalarColumn>& columns) {
    write_by("write_openpmd_particles", at, kind, columns);
}

}  // namespace common
