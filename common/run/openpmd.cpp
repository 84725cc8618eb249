// openpmd.so: snapshots as HDF5 files after the openPMD standard. writers.cpp opens it.
//
// source: The openPMD standard 1.1.0, https://doi.org/10.5281/zenodo.1167843.
#include <hdf5.h>

#include <utility>

#include "common/run/writers.hpp"

namespace common {

namespace {

/// An open thing of HDF5, closed when it goes out of scope.
struct Handle {
    hid_t id;
    herr_t (*close)(hid_t);
    Handle(hid_t opened, herr_t (*closes)(hid_t)) : id(opened), close(closes) {
        if (id < 0) throw InputError("HDF5 refuses it");
    }
    Handle(Handle&& other) : id(std::exchange(other.id, -1)), close(other.close) {}
    ~Handle() {
        if (id >= 0) close(id);
    }
};

void require(herr_t status) {
    if (status < 0) throw InputError("HDF5 refuses it; is the disk full?");
}

Handle group(hid_t parent, const std::string& name) {
    return {H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose};
}

void write_attribute(hid_t parent, const char* name, hid_t type, hid_t space, const void* data) {
    const Handle shape(space, H5Sclose),
        attribute(H5Acreate2(parent, name, type, shape.id, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    require(H5Awrite(attribute.id, type, data));
}
void attribute(hid_t parent, const char* name, double value) {
    write_attribute(parent, name, H5T_NATIVE_DOUBLE, H5Screate(H5S_SCALAR), &value);
}
void attribute(hid_t parent, const char* name, std::uint32_t value) {
    write_attribute(parent, name, H5T_NATIVE_UINT32, H5Screate(H5S_SCALAR), &value);
}
void attribute(hid_t parent, const char* name, const std::vector<double>& values) {
    const hsize_t count = values.size();
    write_attribute(parent, name, H5T_NATIVE_DOUBLE, H5Screate_simple(1, &count, nullptr),
                    values.data());
}
void attribute(hid_t parent, const char* name, const std::string& value) {
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    require(H5Tset_size(type.id, value.size() + 1));
    write_attribute(parent, name, type.id, H5Screate(H5S_SCALAR), value.c_str());
}
void attribute(hid_t parent, const char* name, const std::vector<std::string>& values) {
    // Of one length: h5py reads these as bytes, which openPMD-viewer expects.
    std::size_t width = 1;
    for (const std::string& one : values) width = std::max(width, one.size() + 1);
    std::string letters;
    for (const std::string& one : values) letters += one + std::string(width - one.size(), '\0');
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    require(H5Tset_size(type.id, width));
    const hsize_t count = values.size();
    write_attribute(parent, name, type.id, H5Screate_simple(1, &count, nullptr), letters.data());
}

/// The numbers of one component, compressed and with a checksum; the dataset stays open.
Handle dataset(hid_t parent, const std::string& name, const std::vector<hsize_t>& shape,
               const ScalarColumn& column) {
    const Handle space(H5Screate_simple(int(shape.size()), shape.data(), nullptr), H5Sclose),
        layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    require(H5Pset_obj_track_times(layout.id, false));  // the same bytes for the same numbers
    if (!column.values.empty()) {
        std::vector<hsize_t> chunk = shape;
        for (hsize_t& n : chunk) n = std::min<hsize_t>(n, shape.size() == 1 ? 65536 : 256);
        require(H5Pset_chunk(layout.id, int(chunk.size()), chunk.data()));
        require(H5Pset_shuffle(layout.id));
        require(H5Pset_deflate(layout.id, 4));
        require(H5Pset_fletcher32(layout.id));
    }
    Handle data(H5Dcreate2(parent, name.c_str(), H5T_NATIVE_DOUBLE, space.id, H5P_DEFAULT,
                           layout.id, H5P_DEFAULT),
                H5Dclose);
    require(
        H5Dwrite(data.id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, column.values.data()));
    attribute(data.id, "unitSI", 1.0);
    attribute(data.id, "unit", column.unit.empty() ? "1" : column.unit);
    return data;
}

/// E of E_x, or nothing for a name without a direction.
std::string vector_of(const std::string& name) {
    const bool component = name.size() > 2 && name[name.size() - 2] == '_' &&
                           std::string("xyz").find(name.back()) != std::string::npos;
    return component ? name.substr(0, name.size() - 2) : "";
}

/// Writes every column as a record: those of one vector into a group, others on their own.
/// in: describe(), what the standard asks of a record; describe_component(), of its parts
template <class Describe, class DescribeComponent>
void write_records(hid_t parent, const std::vector<hsize_t>& shape,
                   const std::vector<ScalarColumn>& columns, const Describe& describe,
                   const DescribeComponent& describe_component) {
    std::vector<std::string> done;
    for (const ScalarColumn& column : columns) {
        const std::string vector = vector_of(column.name);
        if (vector.empty()) {
            const Handle data = dataset(parent, column.name, shape, column);
            describe(data.id, column.name), describe_component(data.id);
            continue;
        }
        if (std::ranges::find(done, vector) != done.end()) continue;
        done.push_back(vector);
        const Handle record = group(parent, vector);
        describe(record.id, vector);
        for (const ScalarColumn& part : columns) {
            if (vector_of(part.name) != vector) continue;
            const Handle data =
                dataset(record.id, part.name.substr(part.name.size() - 1), shape, part);
            describe_component(data.id);
        }
    }
}

/// Errors are ours to tell; and at the end of the program nothing is written again that a full disk
/// has refused.
void set_up_library() {
    static const bool once =
        H5dont_atexit() >= 0 && H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr) >= 0;
    require(once ? 0 : -1);
}

/// Makes the file of a snapshot. out: what went wrong, or nothing
/// in: what, "meshes" or "particles"; fill(group), which writes into the group of that name
template <class Fill>
std::string write_file(const std::string& path, const Snapshot& at, const std::string& kind,
                       const std::string& what, const Fill& fill) {
    try {
        set_up_library();
        const Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT),
                          H5Fclose);
        attribute(file.id, "openPMD", std::string("1.1.0"));
        attribute(file.id, "openPMDextension", std::uint32_t(0));
        attribute(file.id, "basePath", std::string("/data/%T/"));
        attribute(file.id, (what + "Path").c_str(), what + "/");
        attribute(file.id, "iterationEncoding", std::string("fileBased"));
        attribute(file.id, "iterationFormat", kind + "_%06T.h5");
        attribute(file.id, "software", std::string("particle-in-cell family"));
        attribute(file.id, "softwareVersion", std::string(PROGRAM_VERSION));
        attribute(file.id, "comment",
                  std::string("numbers are in the units of the run, named by 'unit'"));
        const Handle data = group(file.id, "data");
        const Handle iteration = group(data.id, std::to_string(at.step));
        attribute(iteration.id, "time", at.time);
        attribute(iteration.id, "dt", at.step > 0 ? at.time / double(at.step) : 0.0);
        attribute(iteration.id, "timeUnitSI", 1.0);
        fill(group(iteration.id, what).id);
        require(H5Fflush(file.id, H5F_SCOPE_LOCAL));
        return "";
    } catch (const std::exception& error) {
        return error.what();
    }
}

const std::vector<double> dimensionless(7, 0.0);

}  // namespace

extern "C" __attribute__((visibility("default"))) std::string write_openpmd_mesh(
    const std::string& path, const Snapshot& at, const std::string& kind, const SampledAxis& x,
    const SampledAxis& z, const std::vector<ScalarColumn>& fields) {
    const bool plane = !z.name.empty();
    std::vector<hsize_t> shape{hsize_t(x.count)};
    std::vector<std::string> labels{x.name};
    std::vector<double> spacing{x.step}, offset{x.first};
    if (plane) {
        shape.insert(shape.begin(), hsize_t(z.count));
        labels.insert(labels.begin(), z.name);
        spacing.insert(spacing.begin(), z.step);
        offset.insert(offset.begin(), z.first);
    }
    return write_file(path, at, kind, "meshes", [&](hid_t meshes) {
        write_records(
            meshes, shape, fields,
            [&](hid_t record, const std::string&) {
                attribute(record, "geometry", std::string("cartesian"));
                attribute(record, "dataOrder", std::string("C"));
                attribute(record, "axisLabels", labels);
                attribute(record, "gridSpacing", spacing);
                attribute(record, "gridGlobalOffset", offset);
                attribute(record, "gridUnitSI", 1.0);
                attribute(record, "unitDimension", dimensionless);
                attribute(record, "timeOffset", 0.0);
            },
            [&](hid_t component) {
                attribute(component, "position", std::vector<double>(shape.size(), 0.0));
            });
    });
}

extern "C" __attribute__((visibility("default"))) std::string write_openpmd_particles(
    const std::string& path, const Snapshot& at, const std::string& kind,
    const std::vector<ScalarColumn>& columns) {
    const hsize_t one = 1, count = columns.empty() ? 0 : columns[0].values.size();
    std::vector<ScalarColumn> named = columns;
    std::vector<std::string> directions;
    for (ScalarColumn& column : named) {
        if (column.name.size() > 1) continue;
        if (std::string("xyz").find(column.name) == std::string::npos) continue;
        directions.push_back(column.name);
        column.name = "position_" + column.name;
    }
    return write_file(path, at, kind, "particles", [&](hid_t particles) {
        const Handle all = group(particles, "all");
        attribute(all.id, "particlesOfTheRun", double(at.particles));
        const auto describe = [&](hid_t record, const std::string& name) {
            attribute(record, "unitDimension",
                      name.starts_with("position") ? std::vector<double>{1, 0, 0, 0, 0, 0, 0}
                                                   : dimensionless);
            attribute(record, "timeOffset", 0.0);
            attribute(record, "macroWeighted", std::uint32_t(0));
            attribute(record, "weightingPower", 0.0);
        };
        write_records(all.id, {count}, named, describe, [](hid_t) {});
        const Handle offset = group(all.id, "positionOffset");
        describe(offset.id, "positionOffset");
        for (const std::string& direction : directions) {
            const Handle constant = group(offset.id, direction);
            attribute(constant.id, "value", 0.0);
            write_attribute(constant.id, "shape", H5T_NATIVE_HSIZE,
                            H5Screate_simple(1, &one, nullptr), &count);
            attribute(constant.id, "unitSI", 1.0);
        }
    });
}

}  // namespace common
