// Files for gnuplot and pandas (text columns) and for ParaView (.vti meshes, .vtp particles, .pvd
// lists of them by time).
//
// Every file is written under a temporary name and then renamed, so a file that is there is whole.
// Numbers are written with as many digits as it takes to read the same bits back.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <numeric>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "common/run/output_file.hpp"
#include "common/run/sentence.hpp"

namespace common {

/// Name of the n-th file of a kind: fields_000123.dat for step 123.
inline std::string numbered(const std::string& kind, long step, const std::string& ending) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "_%06ld.", step);
    return kind + digits + ending;
}

/// A time at which a run is written down: fields_000400.dat of step 400, and what goes with it.
struct Snapshot {
    std::string folder;
    long step = 0;
    double time = 0;  // as in the history
    FileFormats also = {};
    long particles = 0;     // of the run, of which a file of particles may hold a sample
    std::string note = {};  // the end of the line of the time

    /// Where a kind of file of this time is, e.g. ("fields", "dat").
    std::string path(const std::string& kind, const std::string& ending) const {
        return folder + "/" + numbered(kind, step, ending);
    }
};

/// About how many particles a file holds at most; so of so many it holds every n-th.
inline constexpr long most_particles_written = 40000;
inline long every_nth_written(long count) {
    return std::max(1L, (count + most_particles_written - 1) / most_particles_written);
}

/// The evenly spaced coordinates of one direction of a mesh; one without a name has a single point
/// and no column.
struct SampledAxis {
    std::string name, unit;
    double first = 0.0, step = 1.0;
    long count = 1;

    /// Coordinate of point i.
    double at(long i) const { return first + double(i) * step; }
};

/// One number per point.
struct ScalarColumn {
    std::string name, unit;
    std::span<const double> values;
};

/// Three numbers per point.
struct VectorColumn {
    std::string name, unit;
    std::span<const double> x, y, z;
};

namespace writers_detail {

/// errors: InputError with the path where a list does not have `count` values
inline void require_length(std::span<const double> values, long count, const std::string& path,
                           const std::string& name) {
    refuse(long(values.size()) != count, path, ": column '", name, "' has ", values.size(),
           " values for ", count, " points");
}

/// The first lines of a table: names_and_units(), and for a snapshot "# time 40 step 400", followed
/// by "particles 65536", how many the run has, in a file that holds a sample of them, and by its note.
inline void begin_table(OutputFile& file, const std::vector<ScalarColumn>& columns,
                        const Snapshot* at = nullptr) {
    file.text(names_and_units(columns));
    if (at == nullptr) return;
    file.text("# time " + number_text(at->time) + " step " + std::to_string(at->step));
    if (at->particles > 0) file.text(" particles " + std::to_string(at->particles));
    file.text(at->note + "\n");
}

/// Text with the four letters that mean something in XML spelled out.
inline std::string xml_text(const std::string& plain) {
    constexpr std::array<const char*, 4> spelled{"&amp;", "&lt;", "&gt;", "&quot;"};
    std::string escaped;
    for (const char c : plain) {
        const std::size_t k = std::string_view("&<>\"").find(c);
        escaped += k < spelled.size() ? spelled[k] : std::string(1, c);
    }
    return escaped;
}

/// The bytes three by three as four letters each.
inline void write_base64(OutputFile& file, std::span<const std::byte> bytes) {
    constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t have = std::min<std::size_t>(3, bytes.size() - i);
        unsigned group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = (group << 8) | (k < have ? std::to_integer<unsigned>(bytes[i + k]) : 0u);
        char four[4];
        for (unsigned k = 0; k < 4; ++k)
            four[k] = k <= have ? letters[(group >> (18 - 6 * k)) & 63u] : '=';
        file.text({four, 4});
    }
}

/// One <DataArray>: a count of bytes and the bytes, in base64.
template <class Number>
void write_data_array(OutputFile& file, const std::string& name, int components,
                      const std::vector<Number>& numbers) {
    const std::uint64_t size = numbers.size() * sizeof(Number);
    std::vector<std::byte> bytes(sizeof size + size);
    std::memcpy(bytes.data(), &size, sizeof size);
    if (size > 0) std::memcpy(bytes.data() + sizeof size, numbers.data(), size);
    const std::string type = std::is_same_v<Number, double> ? "Float64" : "Int64";
    file.text("<DataArray type=\"" + type + "\" Name=\"" + xml_text(name) +
              "\" NumberOfComponents=\"" + std::to_string(components) + "\" format=\"binary\">\n");
    write_base64(file, bytes);
    file.text("\n</DataArray>\n");
}

/// name[unit], or the name alone for a pure number.
inline std::string label(const std::string& name, const std::string& unit) {
    return unit.empty() ? name : name + " [" + unit + "]";
}

/// x0 y0 z0 x1 y1 z1 ..., the order of vectors in VTK files.
inline std::vector<double> interleave(std::span<const double> x, std::span<const double> y,
                                      std::span<const double> z) {
    std::vector<double> mixed;
    for (std::size_t i = 0; i < x.size(); ++i) mixed.insert(mixed.end(), {x[i], y[i], z[i]});
    return mixed;
}

/// The section of a VTK file that holds the quantities at its points.
inline void write_point_data(OutputFile& file, const std::string& path, long count,
                             const std::vector<ScalarColumn>& scalars,
                             const std::vector<VectorColumn>& vectors) {
    file.text("<PointData>\n");
    for (const auto& s : scalars) {
        require_length(s.values, count, path, s.name);
        write_data_array(file, label(s.name, s.unit), 1,
                         std::vector<double>(s.values.begin(), s.values.end()));
    }
    for (const auto& v : vectors) {
        for (const auto& part : {v.x, v.y, v.z}) require_length(part, count, path, v.name);
        write_data_array(file, label(v.name, v.unit), 3, interleave(v.x, v.y, v.z));
    }
    file.text("</PointData>\n");
}

/// The first lines of a VTK file of this type.
inline void begin_vtk_file(OutputFile& file, const std::string& type) {
    const std::string first = std::endian::native == std::endian::little ? "Little" : "Big";
    file.text("<?xml version=\"1.0\"?>\n<VTKFile type=\"" + type +
              "\" version=\"1.0\" byte_order=\"" + first + "Endian\" header_type=\"UInt64\">\n");
}

/// The time of a VTK file, under the name that ParaView knows.
inline void write_time(OutputFile& file, double time) {
    file.text(
        "<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
        "format=\"ascii\">" +
        number_text(time) + "</DataArray>\n</FieldData>\n");
}

/// Adds a file to the list of its kind, fields.pvd, which ParaView opens as one thing in time. Lines
/// of this step and later steps are those of a run that has gone back to an earlier checkpoint.
inline void add_to_collection(const Snapshot& at, const std::string& kind,
                              const std::string& ending) {
    const std::string path = at.folder + "/" + kind + ".pvd", start = "<DataSet timestep=",
                      name = "\" file=\"" + numbered(kind, at.step, ending) + "\"/>\n";
    std::string earlier;
    std::ifstream before(path);
    for (std::string line; std::getline(before, line);) {
        const std::size_t file = line.rfind(kind + "_");
        if (!line.starts_with(start) || file == std::string::npos) continue;
        if (std::strtol(line.c_str() + file + kind.size() + 1, nullptr, 10) < at.step)
            earlier += line + "\n";
    }
    OutputFile list(path);
    list.text(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n" +
        earlier + start + "\"" + number_text(at.time) + name + "</Collection>\n</VTKFile>\n");
    list.finish();
}

}  // namespace writers_detail

/// Writes fields_000400.h5: each field a mesh record, E_x and E_z components of one, in the order
/// z, x; each with its unit as an attribute.
/// exact:  the values are the bits given
/// errors: InputError with the path where the file cannot be written
/// source: The openPMD standard 1.1.0.
void write_openpmd_mesh(const Snapshot& at, const std::string& kind, const SampledAxis& x,
                        const SampledAxis& z, const std::vector<ScalarColumn>& fields);
/// The same for particles_000400.h5: x, y, z are the position, all others records of their own.
void write_openpmd_particles(const Snapshot& at, const std::string& kind,
                             const std::vector<ScalarColumn>& columns);

/// Writes columns of equal length, one row per particle or time.
/// in:    columns, each with its name for the first line and its unit for the second; the snapshot
///        to which they belong, for the third
/// exact: numbers read back have the same bits; on failure nothing appears under `path`
inline void write_table(const std::string& path, const std::vector<ScalarColumn>& columns,
                        const Snapshot* at = nullptr) {
    const long rows = columns.empty() ? 0 : long(columns.front().values.size());
    for (const auto& c : columns) writers_detail::require_length(c.values, rows, path, c.name);
    OutputFile file(path);
    writers_detail::begin_table(file, columns, at);
    for (std::size_t row = 0; row < std::size_t(rows); ++row) {
        for (std::size_t k = 0; k < columns.size(); ++k) {
            if (k > 0) file.text(" ");
            file.number(columns[k].values[row]);
        }
        file.text("\n");
    }
    file.finish();
}
inline void write_table(const Snapshot& at, const std::string& kind,
                        const std::vector<ScalarColumn>& columns) {
    write_table(at.path(kind, "dat"), columns, &at);
    if (at.also.openpmd && kind == "particles") write_openpmd_particles(at, kind, columns);
}

/// Writes fields on a plane mesh for gnuplot: columns x, z, fields; an empty line after each row of
/// the mesh.
/// in:    axes x and z; fields of x.count * z.count values, x fastest
/// exact: as write_table
inline void write_fields(const std::string& path, const SampledAxis& x, const SampledAxis& z,
                         const std::vector<ScalarColumn>& fields, const Snapshot* at = nullptr) {
    for (const auto& f : fields)
        writers_detail::require_length(f.values, x.count * z.count, path, f.name);
    std::vector<ScalarColumn> columns{{x.name, x.unit, {}}};
    if (!z.name.empty()) columns.push_back({z.name, z.unit, {}});
    columns.insert(columns.end(), fields.begin(), fields.end());
    OutputFile file(path);
    writers_detail::begin_table(file, columns, at);
    const auto next = [&](double value) { file.text(" "), file.number(value); };
    for (long j = 0; j < z.count; ++j) {
        for (long i = 0; i < x.count; ++i) {
            file.number(x.at(i));
            if (!z.name.empty()) next(z.at(j));
            for (const auto& f : fields) next(f.values[std::size_t(j * x.count + i)]);
            file.text("\n");
        }
        file.text("\n");
    }
    file.finish();
}
inline void write_fields(const Snapshot& at, const std::string& kind, const SampledAxis& x,
                         const SampledAxis& z, const std::vector<ScalarColumn>& fields) {
    write_fields(at.path(kind, "dat"), x, z, fields, &at);
    if (at.also.openpmd) write_openpmd_mesh(at, kind, x, z, fields);
}

/// Writes fields on a mesh for ParaView (VTK image data, point data in base64).
/// in:    axes x, y, z, one point in a direction that the mesh does not have; scalars and vectors
///        of one value per point, x fastest and z slowest
/// exact: well-formed XML; the values are the bits given
/// source: The VTK User's Guide, "VTK File Formats".
inline void write_vti(const Snapshot& at, const std::string& kind,
                      const std::array<SampledAxis, 3>& axes,
                      const std::vector<ScalarColumn>& scalars,
                      const std::vector<VectorColumn>& vectors) {
    const std::string path = at.path(kind, "vti");
    OutputFile file(path);
    writers_detail::begin_vtk_file(file, "ImageData");
    std::string extent, origin, spacing;
    for (const auto& axis : axes) {
        const std::string gap = extent.empty() ? "" : " ";
        extent += gap + "0 " + std::to_string(axis.count - 1);
        origin += gap + number_text(axis.first);
        spacing += gap + number_text(axis.step);
    }
    file.text("<ImageData WholeExtent=\"" + extent + "\" Origin=\"" + origin + "\" Spacing=\"" +
              spacing + "\">\n");
    writers_detail::write_time(file, at.time);
    file.text("<Piece Extent=\"" + extent + "\">\n");
    const long points = axes[0].count * axes[1].count * axes[2].count;
    writers_detail::write_point_data(file, path, points, scalars, vectors);
    file.text("<CellData></CellData>\n</Piece>\n</ImageData>\n</VTKFile>\n");
    file.finish();
    writers_detail::add_to_collection(at, kind, "vti");
}

/// Writes particles for ParaView (VTK poly data, one vertex per particle).
/// in:    positions of n particles; scalars and vectors of n values
/// exact: as write_vti
inline void write_vtp(const Snapshot& at, const std::string& kind, const VectorColumn& position,
                      const std::vector<ScalarColumn>& scalars,
                      const std::vector<VectorColumn>& vectors) {
    const std::string path = at.path(kind, "vtp");
    const long points = long(position.x.size());
    for (const auto& part : {position.x, position.y, position.z})
        writers_detail::require_length(part, points, path, position.name);
    OutputFile file(path);
    writers_detail::begin_vtk_file(file, "PolyData");
    const std::string count = std::to_string(points);
    file.text("<PolyData>\n");
    writers_detail::write_time(file, at.time);
    file.text("<Piece NumberOfPoints=\"" + count + "\" NumberOfVerts=\"" + count +
              "\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n");
    writers_detail::write_point_data(file, path, points, scalars, vectors);
    file.text("<Points>\n");
    writers_detail::write_data_array(
        file, "Points", 3, writers_detail::interleave(position.x, position.y, position.z));
    file.text("</Points>\n<Verts>\n");
    std::vector<std::int64_t> connectivity(position.x.size()), offsets(position.x.size());
    std::iota(connectivity.begin(), connectivity.end(), 0);
    std::iota(offsets.begin(), offsets.end(), 1);
    writers_detail::write_data_array(file, "connectivity", 1, connectivity);
    writers_detail::write_data_array(file, "offsets", 1, offsets);
    file.text("</Verts>\n</Piece>\n</PolyData>\n</VTKFile>\n");
    file.finish();
    writers_detail::add_to_collection(at, kind, "vtp");
}

}  // namespace common
