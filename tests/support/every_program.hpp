// The seven programs, the cases that tests start, and how a table names them in words.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace facts {

/// One program as the tests of all programs see it.
struct Program {
    std::string name;
    std::string method;      // the folder of its cases
    std::string choice;      // a parameter that takes one of several words
    std::string item, key;   // what a case may hold several of; a parameter of it, a number
    std::string short_case;  // text of a case that ends at once
    std::string beam;        // overrides of that, so that it holds one item of each kind, "beam"
    std::string words;       // names of cases and of settings, see expand()
};

/// A command of a table: a program and the words that follow it; then what is expected of it.
struct Command {
    const Program* program;
    std::string words;
    std::vector<std::string> expected;
};

/// What words stand for.
struct Arguments {
    std::string file;  // a path from the root of the project, or nothing
    std::vector<std::pair<std::string, std::string>> overrides;
    std::string options;
};

// ---- the words ----------------------------------------------------------------------------------
// Each line names a case file, settings, or other names. What comes later replaces what came
// before.

// Electrons and a fixed background on a line and in the plane; electrons and ions between two
// walls. Then runs: two beams, on a line and in the plane, where particles are sorted every 25
// steps; a source and an absorbing wall, both floating; a layer between grounded walls that its
// field drives apart, against a weak magnetic field; a magnetized box with a source, an absorbing
// wall and two mirrors.
inline const std::string words_of_cic = R"(
background species.ions.charge=1 species.ions.motion=fixed
electrons species.electrons.particles_per_cell=8
line grid.cells_x=16 grid.length_x=6 time.end=2 background electrons
plane line grid.dimensions=2 grid.cells_x=8 grid.cells_z=8 grid.length_z=6
between_walls grid.cells_x=16 grid.length_x=6 grid.boundary_x=wall time.end=2 electrons \
    species.electrons.temperature_x=1 species.ions.charge=1 species.ions.mass=100 species.ions.particles_per_cell=8
box grid.boundary_x=wall grid.boundary_z=wall
at_1_1 species.electrons.center_x=1 species.electrons.center_z=1
wave theory.compare=wave
traveling species.electrons.amplitude=0.1 species.electrons.wave=traveling
points_at_ends species.electrons.profile=point species.electrons.density=2 \
    species.electrons.center_x=6 species.ions.motion=mobile species.ions.density=2 \
    species.ions.profile=point species.ions.center_z=6
no_charge species.electrons.charge=0 species.ions.charge=0
streams two_stream.toml species.right.particles_per_cell=16 species.left.particles_per_cell=16
plane_streams two_stream_2d.toml grid.cells_x=32 grid.cells_z=16 species.right.loading=random \
    species.left.temperature_x=0.01 species.left.loading=quiet
floating sheath.toml time.dt=0.4 grid.cells_x=48 grid.length_x=12
layer diocotron.toml theory.compare=none plasma.B_y=0.3 grid.cells_x=32 grid.cells_z=32 \
    species.electrons.particles_per_cell=16 species.electrons.half_width=7 \
    species.electrons.start=drift
mirrors plane_streams box theory.compare=none boundary.potential_x_high=1 plasma.B_y=0.2 \
    boundary.particles_x_low=source boundary.particles_z_low=reflect \
    boundary.particles_z_high=reflect species.right.amplitude=0 species.left.amplitude=0 \
    species.right.emission=0.3 species.left.emission=0.1
run streams time.end=2 theory.compare=none
)";

// Gas in a tube and in a box between walls, in a box with periodic ends, and a shock tube; and what
// comparisons are about. Then runs: Sod's tube between walls; gas that comes in at one end and is
// held up by a wall, or leaves at the other end against the pressure there; a disk that turns in a
// void until gravity lets it fall out of the mesh; two gases, one above the other; particles
// anywhere, with noise; a vortex.
inline const std::string words_of_fluids = R"(
walls_x boundary.x_low=slip boundary.x_high=slip
walls_z boundary.z_low=slip boundary.z_high=slip
no_slip boundary.x_low=no_slip boundary.x_high=no_slip boundary.z_low=no_slip \
    boundary.z_high=no_slip
around_x boundary.x_low=periodic boundary.x_high=periodic
gas time.end=0.1 region.gas.density=1
tube walls_x gas
around grid.cells_x=32 grid.cells_z=32 gas
box around walls_x walls_z
rings grid.geometry=axisymmetric
sod walls_x time.end=0.1 setup.kind=riemann
dust material.dust.gamma=1
water material.water.gamma=4.4 material.water.p_infinity=600
disk region.gas.shape=disk
rotation region.gas.flow=rotation
sound region.gas.flow=wave region.gas.amplitude=0.01
heavy region.heavy.shape=above region.heavy.center_z=0.5 region.heavy.density=2
shear region.gas.flow=shear region.gas.center_z=0.5 region.gas.speed=0.1 region.gas.width=0.05
gaussian region.gas.flow=gaussian region.gas.amplitude=1 region.gas.width=0.05 \
    region.gas.velocity_x=1 time.dt=0.001
gresho region.gas.flow=gresho region.gas.speed=1 region.gas.width=0.4
radial region.gas.flow=radial region.gas.speed=1
hot region.hot.shape=disk region.hot.radius=0.05 region.hot.center_x=0.5 region.hot.center_z=0.5 \
    region.hot.energy=1
dam gravity.z=-1 region.gas.shape=box region.gas.half_x=0.2 region.gas.half_z=0.4 \
    region.gas.center_x=0.2 region.gas.center_z=0.4 theory.compare=dam_break
shock_tube sod.toml grid.cells_x=40 time.end=0.15
wind piston.toml grid.cells_x=40 time.end=0.3
channel piston.toml theory.compare=none grid.cells_x=24 grid.cells_z=6 grid.length_z=0.25 \
    boundary.x_low=open boundary.pressure_x_low=0.8 walls_z particles.per_cell_x=3 \
    particles.per_cell_z=2 time.end=0.2
falling rotating_disk.toml grid.cells_x=20 grid.cells_z=20 time.dt=0.03 time.end=1 gravity.x=0.6 \
    theory.compare=none
layers rayleigh_taylor.toml grid.cells_x=10 grid.cells_z=20 time.end=0.4 \
    output.particles_interval=0
noise piston.toml grid.cells_x=30 time.end=0.3 particles.loading=random region.gas.noise=0.1
implicit viscosity.linear=0 viscosity.quadratic=0 flip.pressure=implicit
vortex gresho.toml grid.cells_x=12 grid.cells_z=12 time.end=0.3 \
    region.gas.pressure=70.92857142857143
rezoned rezone.steps=5 rezone.min_particles=5 rezone.max_particles=10
rezoned_vortex vortex flip.density=cells rezone.steps=5 rezone.min_particles=10 \
    rezone.max_particles=20
held layers boundary.z_low=no_slip boundary.z_high=no_slip boundary.slide_z_high=0.5 \
    flip.viscosity=0.01
swirling rotating_column.toml theory.compare=none grid.cells_x=10 grid.cells_z=12 constant.A.value=0.3 \
    boundary.z_low=inflow boundary.z_high=open boundary.pressure_z_high=11 inflow.pressure=11.4 \
    inflow.velocity_z=0.3 inflow.angular_velocity=2 time.end=0.3
run shock_tube
)";

// Two disks on cells of 0.05 that fly towards each other, the same on a periodic mesh, a disk
// between a plate that is driven and one that a force drives, and a box that fills its mesh. Then
// what runs of both programs are made of.
inline const std::string words_of_grains = R"(
mesh grid.cells_x=24 grid.cells_y=12 grid.length_x=1.2
end time.end=0.1
left grain.left.x=0.35 grain.left.y=0.3 grain.left.radius=0.2 grain.left.velocity_x=0.1
right grain.right.x=0.85 grain.right.y=0.3 grain.right.radius=0.2 grain.right.velocity_x=-0.1
disks mesh end left right
periodic grid.periodic_x=true
plate grain.bottom.shape=box grain.bottom.width=1 grain.bottom.height=0.1 \
    grain.bottom.material=plate grain.top.shape=box grain.top.width=1 grain.top.height=0.1 \
    grain.top.material=plate
plates mesh end material.plate.law=rigid grain.disk.x=0.6 grain.disk.y=0.3 grain.disk.radius=0.2 \
    grain.bottom.x=0.6 grain.bottom.y=0.05 grain.top.x=0.6 grain.top.y=0.55 \
    grain.top.control=force_y plate
body grid.cells_x=8 grid.cells_y=4 grid.length_x=0.8 end grain.body.shape=box grain.body.x=0.4 \
    grain.body.y=0.2 grain.body.width=0.8 grain.body.height=0.4
small body grid.cells_x=2 grid.cells_y=2 grain.body.y=0.4 grain.body.height=0.8 \
    load.gravity_y=-1e-3
slip boundary.x_low=slip boundary.x_high=slip boundary.y_low=slip boundary.y_high=slip
stick boundary.x_low=stick boundary.x_high=stick boundary.y_low=stick boundary.y_high=stick
rub boundary.x_low=frictional boundary.x_high=frictional boundary.y_low=frictional \
    boundary.y_high=frictional
polygon grain.left.shape=polygon
touching grain.left.x=0.4 grain.right.x=0.8
joint bond.joint.a=left bond.joint.b=right
bar grain.body.amplitude=1e-3 grain.body.profile=bar
wave grain.body.amplitude=1e-3 grain.body.profile=wave
rows pack.row.x=0.3 pack.row.y=0.1 pack.row.rows=1 pack.row.columns=3
packed pack.p.count=50 pack.p.width=1.2 pack.p.height=0.6 pack.p.radius_min=0.1 \
    pack.p.radius_max=0.1
one_disk pack.p.x=0.2 pack.p.y=0.2 pack.p.rows=1 pack.p.columns=1
written_pack grid.cells_x=20 grid.cells_y=16 grid.length_x=1 end output.pack=true \
    contact.friction=0.3 pack.p.count=5 pack.p.columns=2 pack.p.rows=2 pack.p.velocity_x=-0.2 \
    pack.p.shear_rate=1 pack.p.radius_min=0.1 pack.p.radius_max=0.15
no_files output.particles_interval=0 output.fringes_interval=0
slow_shear mpm_explicit/cases/shear.toml output.history_steps=1 output.pixels_per_cell=1 \
    grid.cells_x=25 grid.cells_y=23
fast pack.top.velocity_x=2 pack.disk.shear_rate=2.8 material.default.E=1e6
newton solver.kind=newton_krylov
)";

// Two disks that meet at t = 0.1 and are in contact at the end; grains between rough plates, so
// fast that particles are sorted again every 20 steps and grains cross the ends of the periodic
// mesh; two halves of a bar whose bond breaks at t = 4; a disk between two plates, of which a force
// drives one; a disk that yields at a wall; a column of sand between rubbing walls, damped; a belt
// around a periodic mesh, on which a disk lands and rubs.
inline const std::string words_of_mpm_explicit = words_of_grains + R"(
rebound rebound.toml theory.compare=none grid.cells_x=24 grid.cells_y=12 grain.left.x=0.39 \
    grain.right.x=0.81 time.end=0.3
shear slow_shear fast no_files time.end=0.04
bonded bonded_bar.toml theory.compare=none bond.joint.tension=0.3 time.end=5
squeeze diametral_disk.toml theory.compare=none output.history_steps=1 grid.cells_x=20 \
    grid.cells_y=20 no_files
press squeeze load.rise=0.04 time.end=0.08
small_disk yielding_disk.toml theory.compare=none grid.cells_x=12 grid.cells_y=12
yielding small_disk grain.disk.x=0.22 grain.disk.velocity_x=-1 time.end=0.05
sand small_disk grain.disk.shape=box grain.disk.width=0.3 grain.disk.height=0.4 grain.disk.x=0.3 \
    grain.disk.y=0.2 grain.disk.velocity_x=0.1 boundary.y_low=frictional boundary.friction=0.4 \
    load.gravity_y=-10 load.damping=1 material.default.law=drucker_prager time.end=0.1
bar_wave standing_wave.toml theory.compare=none
belt periodic grid.cells_x=20 grid.cells_y=12 grid.length_x=1 boundary.y_low=slip \
    contact.friction=0.5 grain.belt.shape=box grain.belt.x=0.5 grain.belt.y=0.1 \
    grain.belt.width=1 grain.belt.height=0.2 grain.belt.velocity_x=0.5 grain.disk.x=0.95 \
    grain.disk.y=0.31 grain.disk.velocity_x=1 grain.disk.velocity_y=-0.1 time.end=0.15
run rebound
)";

// Two disks that meet at t = 0.1, off their line of centers, and rub on each other to the end; the
// shear of mpm_explicit in longer steps; a bond that breaks at t = 0.7; the rest as there.
inline const std::string words_of_mpm_implicit = words_of_grains + R"(
rebound rebound.toml theory.compare=none grid.cells_x=24 grid.cells_y=12 grain.left.x=0.39 \
    grain.left.y=0.35 grain.left.velocity_y=0.1 grain.right.x=0.81 contact.friction=0.2 \
    time.end=0.3
shear slow_shear fast no_files time.alpha=1 time.end=0.04
bonded bonded_bar.toml theory.compare=none bond.joint.tension=0.3 time.alpha=1 time.end=6
press diametral_disk.toml theory.compare=none grid.cells_x=20 grid.cells_y=20 \
    grid.particles_per_side=2 load.rise=0.04 time.end=0.4 no_files
yielding yielding_disk.toml theory.compare=none grid.cells_x=12 grid.cells_y=12 \
    grain.disk.x=0.22 time.end=0.4
bar_wave standing_wave.toml theory.compare=none time.alpha=1
run rebound
)";

// A uniform plasma with a species; what comparisons are about. Then runs: a small Harris sheet; a
// current sheet across the plane; two beams.
inline const std::string words_of_plasmas = R"(
uniform plasma.setup=uniform grid.boundary_z=periodic
beam uniform species.beam.charge=-1
electrons uniform species.electrons.charge=-1
light uniform theory.wave=light
langmuir uniform theory.wave=langmuir
cold uniform theory.wave=cold
magnetized uniform theory.wave=magnetized
transverse uniform theory.wave=transverse
longitudinal uniform theory.wave=longitudinal
wave_E_y uniform.wave_E_y=1
few grid.cells_x=4 grid.cells_z=4
)";
inline const std::string words_of_implicit_moment = words_of_plasmas + R"(
sheet gem.toml harris.particles=4000 grid.cells_x=16 grid.cells_z=16
thin_sheet lhdi_quick.toml current_sheet.particles=4000 grid.cells_x=34 grid.cells_z=16 \
    output.fields_interval=0 output.profile_interval=0.8 time.end=4
streams two_stream.toml uniform.particles_per_cell=16 time.end=2
newton field.solver=newton_krylov
run sheet time.end=3
)";
inline const std::string words_of_explicit_em = words_of_plasmas + R"(
sheet gem_explicit.toml grid.cells_x=32 grid.cells_z=16 time.dt=0.2 harris.particles=6000 \
    output.fields_interval=0 output.checkpoint_steps=0 output.history_steps=1
streams explicit_two_stream.toml uniform.particles_per_cell=16 time.end=2 output.history_steps=1
run sheet time.end=4
)";

// ---- the programs -------------------------------------------------------------------------------
inline const std::string one_species = "[time]\nend = 0\n[species.beam]\ncharge = 0\n",
                         one_region = "[time]\nend = 0\n[region.beam]\n",
                         one_grain = "[time]\nend = 0\n[grain.beam]\nx = 0.6\ny = 0.45\n",
                         one_sheet =
                             "[time]\nend = 0\n[harris]\nparticles = 2\n[grid]\ncells_x = 8\n"
                             "cells_z = 8\n",
                         beam_of_cic =
                             "constant.beam.value=1 species.beam.density=beam "
                             "perturbation.beam.species=beam perturbation.beam.amplitude=0.1",
                         beam_of_grains =
                             "material.beam.E=1 pack.beam.x=0.2 pack.beam.y=0.15 "
                             "pack.beam.columns=2 pack.beam.rows=1 bond.beam.tension=1 "
                             "pair.beam.friction=1",
                         beam_of_plasma =
                             "plasma.setup=uniform grid.boundary_z=periodic "
                             "species.beam.drift_x=0.1 uniform.particles_per_cell=1";

inline const std::vector<Program>& every_program() {
    static const std::string
        compare = "theory.compare",
        setup = "plasma.setup",
        gas =
            "material.beam.gamma=1.5 constant.beam.value=1 region.beam.density=beam "
            "boundary.x_low=inflow boundary.x_high=slip inflow.x_low.density=1 "
            "inflow.x_low.pressure=1 inflow.x_low.velocity_x=1 "
            "inflow.x_low.velocity_z=0 inflow.x_low.velocity_theta=0 "
            "inflow.x_low.angular_velocity=0",
        density = "density";
    static const std::vector<Program> all{
        {"cic", "cic", compare, "species", density, one_species, beam_of_cic, words_of_cic},
        {"pic", "flip", compare, "region", density, one_region, gas, words_of_fluids},
        {"flip", "flip", compare, "region", density, one_region, gas, words_of_fluids},
        {"mpm_explicit", "mpm_explicit", compare, "grain", "radius", one_grain, beam_of_grains,
         words_of_mpm_explicit},
        {"mpm_implicit", "mpm_implicit", compare, "grain", "radius", one_grain, beam_of_grains,
         words_of_mpm_implicit},
        {"implicit_moment", "implicit_moment", setup, "species", density, one_sheet, beam_of_plasma,
         words_of_implicit_moment},
        {"explicit_em", "implicit_moment", setup, "species", density, one_sheet, beam_of_plasma,
         words_of_explicit_em}};
    return all;
}

// ---- tables -------------------------------------------------------------------------------------

/// Words as a shell separates them, with their quotes.
inline std::vector<std::string> words_in(const std::string& text) {
    std::vector<std::string> words;
    char quote = 0;
    bool inside = false;
    for (const char c : text) {
        if (quote == 0 && c == ' ') {
            inside = false;
            continue;
        }
        if (!inside) words.emplace_back();
        inside = true;
        words.back() += c;
        if (quote == c)
            quote = 0;
        else if (quote == 0 && (c == '\'' || c == '"'))
            quote = c;
    }
    return words;
}

/// Lines without comments and empty ones; one that ends in a backslash goes on in the next.
inline std::vector<std::string> lines_in(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream all(text);
    bool goes_on = false;
    for (std::string line; std::getline(all, line);) {
        if (line.empty() || line[0] == '#') continue;
        if (goes_on)
            lines.back() += line.substr(line.find_first_not_of(' '));
        else
            lines.push_back(line);
        goes_on = lines.back().back() == '\\';
        if (goes_on) lines.back().pop_back();
    }
    return lines;
}

inline std::string joined(const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) {
        if (!text.empty()) text += " ";
        text += line;
    }
    return text;
}

/// The programs that a name at the beginning of a line stands for.
inline std::vector<const Program*> programs_called(const std::string& name) {
    std::vector<const Program*> found;
    for (const Program& program : every_program()) {
        const bool grains = program.item == "grain", fluids = program.item == "region",
                   plasmas = program.method == "implicit_moment";
        if (name == program.name || name == "every" || (name == "grains" && grains) ||
            (name == "fluids" && fluids) || (name == "plasmas" && plasmas))
            found.push_back(&program);
    }
    INFO("there is no program '" << name << "'");
    REQUIRE(!found.empty());
    return found;
}
inline const Program& program_called(const std::string& name) { return *programs_called(name)[0]; }

/// The commands of a table. A line that begins with the name of a program, or with "fluids",
/// "grains", "plasmas" or "every" for several, is a command; what is expected of all commands since
/// the last expectation follows behind " -> ", or in lines that are indented.
inline std::vector<Command> commands(const std::string& table) {
    std::vector<Command> all;
    std::size_t first = 0;  // of those that the next expectation belongs to
    bool expected = false;
    const auto expect = [&](const std::string& line) {
        for (std::size_t k = first; k < all.size(); ++k) all[k].expected.push_back(line);
        expected = true;
    };
    for (const std::string& line : lines_in(table)) {
        if (line[0] == ' ') {
            expect(line.substr(line.find_first_not_of(' ')));
            continue;
        }
        if (expected) first = all.size();
        expected = false;
        const std::size_t arrow = std::min(line.find(" -> "), line.size()),
                          space = std::min(line.find(' '), arrow);
        for (const Program* program : programs_called(line.substr(0, space)))
            all.push_back({program, line.substr(space, arrow - space), {}});
        if (arrow < line.size()) expect(line.substr(arrow + 4));
    }
    REQUIRE(!all.empty());
    return all;
}

/// What the words of a command stand for: section.key=value is an override, which replaces an
/// earlier one of the same key; NAME.toml a case of the program, or a path from the root of the
/// project; another word one that the program has defined, or an option.
inline void expand(const std::string& text, const Program& program, Arguments& found) {
    for (const std::string& word : words_in(text)) {
        const std::size_t equals = word.find('=');
        if (word[0] == '-' || (equals == std::string::npos && !found.options.empty())) {
            found.options += " " + word;
            continue;
        }
        if (equals != std::string::npos) {
            const std::string key = word.substr(0, equals), value = word.substr(equals + 1);
            const auto same = std::find_if(found.overrides.begin(), found.overrides.end(),
                                           [&](const auto& one) { return one.first == key; });
            if (same == found.overrides.end())
                found.overrides.emplace_back(key, value);
            else
                same->second = value;
            continue;
        }
        if (word.ends_with(".toml")) {
            const bool is_path = word.find('/') != std::string::npos;
            found.file = is_path ? word : program.method + "/cases/" + word;
            continue;
        }
        bool known = false;
        for (const std::string& line : lines_in(program.words)) {
            if (line.substr(0, line.find(' ')) != word) continue;
            expand(line.substr(line.find(' ')), program, found);
            known = true;
            break;
        }
        INFO(program.name << ": " << text);
        if (!known) FAIL("unknown word '" << word << "'");
    }
}

}  // namespace facts
