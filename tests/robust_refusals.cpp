// What each program alone refuses, with the number and the cure in one sentence, and nothing
// written. How files and command lines are read is what all programs share: see
// robust_every_input.cpp.
#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "tests/support/any_program.hpp"

using namespace facts;

TEST_CASE("a mesh or a time step that cannot run is refused" * doctest::description("robust")) {
    check_refused(R"(
cic line grid.cells_z=8 -> grid.cells_z = 8 needs grid.dimensions = 2
cic line grid.boundary_z=wall -> grid.boundary_z = "wall" needs grid.dimensions = 2
cic plane grid.cells_z=1 -> grid.dimensions = 2 needs grid.cells_z of at least 2
cic plane grid.cells_x=2 box -> a box needs at least 3 x 3 cells
cic plane grid.cells_x=4096 grid.cells_z=4096 box
    a box between four walls of 4096 x 4096 cells is more than the 4e6 whose matrix is factorized in
    minutes: take fewer, or make one direction periodic
cic line time.dt=1e-9
    time.end / time.dt is 2e+09 steps, more than 1e9: raise time.dt or lower time.end
cic line time.dt=1e-30 time.end=1e30 -> time.end / time.dt is 1e+60 steps, more than 1e9
cic line time.dt=2
    omega_p dt = 2 is not below 2, where the leapfrog blows up: lower time.dt below 2
cic between_walls time.dt=1.999
    omega_p dt = 2.009 is not below 2, where the leapfrog blows up: lower time.dt below 1.99
cic line time.dt=0.3 species.electrons.density=100 species.ions.density=100
    omega_p dt = 3 is not below 2, where the leapfrog blows up: lower time.dt below 0.2
cic line species.electrons.drift_x=100
    species.electrons: particles move 1.667 times the length of the box in one step: lower time.dt
    below 0.06
cic line gauss.sign=0.5 -> gauss.sign = 0.5 is neither 1 nor -1
cic line method.scheme=energy method.weighting=ngp
    method.scheme = "energy" gathers with one order less than it deposits, and there is none below
    method.weighting = "ngp": take "cic" or "tsc"
cic line method.stencil=nine_point -> method.stencil = "nine_point" needs grid.dimensions = 2
)");
}

TEST_CASE("a plasma that is not one is refused with its charge or its number of particles" *
          doctest::description("robust")) {
    check_refused(R"(
cic -> there is no plasma: add a [species.<name>]
cic background -> every species is fixed, so nothing can happen: make one mobile
cic grid.length_x=6 species.electrons.density=1
    the plasma is not neutral: its charge is -6, -100 % of the sum of all charges, and there is no
    grounded wall to carry the opposite: change a density, or add a fixed species with density 1 and
    charge 1
cic line species.ions.density=3
    the plasma is not neutral: its charge is 12, 50 % of the sum of all charges
cic plane species.ions.density=3 -> or add a fixed species with density 2 and charge -1
cic between_walls boundary.x_low=floating boundary.x_high=floating species.ions.density=1.5
    the plasma is not neutral: its charge is 3, 20 % of the sum of all charges
cic plane species.electrons.profile=point species.electrons.density=36 at_1_1
    the case has 1 particle, and alone it only feels itself: raise particles_per_cell,
    or add a species
cic plane species.electrons.particles_per_cell=1e7 grid.cells_x=64 grid.cells_z=64
    4.096e+10 particles are more than 2e9: lower particles_per_cell
cic plane species.electrons.profile=disk at_1_1 species.electrons.half_width=1e-3
    species.electrons has no particle: raise particles_per_cell, or its half_width of 0.001
cic line species.electrons.density=0
    species.electrons.density = 0 leaves its particles without charge and mass: raise it, or take
    the species out
)");
}

TEST_CASE("species that cannot be loaded are refused with the cure" *
          doctest::description("robust")) {
    check_refused(R"(
cic plane species.ions.profile=disk
    species.ions: a fixed species is a uniform background: take out profile, or make it mobile and
    heavy
cic line species.ions.amplitude=0.1
cic line species.ions.drift_x=1
cic line species.ions.temperature_x=1
cic line species.ions.ripple=1
cic line species.ions.emission=1
cic line species.ions.distribution_x=1 species.ions.distribution_max=1
cic line perturbation.a.species=ions perturbation.a.amplitude=0.1
    species.ions: a fixed species stays as it is: take out drift, temperature, distribution,
    amplitude, perturbation, ripple and emission, or make it mobile
cic line species.electrons.profile=layer
    species.electrons.profile = "layer" needs grid.dimensions = 2
cic line species.electrons.profile=disk
    species.electrons.profile = "disk" needs grid.dimensions = 2
cic plane species.electrons.profile=layer -> species.electrons.half_width = 0: a layer needs a width
cic plane species.electrons.profile=disk -> species.electrons.half_width = 0: a disk needs a width
cic plane species.electrons.half_width=2 species.electrons.ripple=0.5 at_1_1 \
    species.electrons.profile=layer
    species.electrons: the layer reaches beyond the box, from z = -1.5 to 3.5 in a box from 0 to 6
cic plane species.electrons.half_width=2 at_1_1 species.electrons.profile=disk
    species.electrons: the disk reaches beyond the box: move species.electrons.center_x or center_z,
    or make it smaller
cic plane species.electrons.profile=point species.electrons.center_x=6.1
    species.electrons: the point reaches beyond the box
cic plane species.electrons.ripple=0.1 -> species.electrons.ripple belongs to profile = "layer"
cic plane species.electrons.half_width=0.5 species.electrons.ripple=0.1 species.electrons.mode_x=0 \
    at_1_1 species.electrons.profile=layer
    species.electrons.ripple = 0.1 has no wave number: set mode_x
cic plane species.electrons.half_width=0.5 species.electrons.loading=lattice at_1_1 \
    species.electrons.profile=disk
    species.electrons.loading = "lattice" fills the whole box: take "quiet" for a disk
cic line species.electrons.temperature_x=1 species.electrons.loading=lattice
    species.electrons.loading = "lattice" is for cold species: take "quiet"
cic plane species.electrons.drift_y=1
    species.electrons has a velocity out of the plane, which nothing can see without a magnetic
    field: take out drift_y, temperature_y and distribution_y, or set plasma.B_x, B_y or B_z
cic line species.electrons.temperature_z=1
    species.electrons has a velocity along z, which nothing can see in one dimension without a
    magnetic field: take out drift_z, temperature_z, distribution_z and distribution_across
cic line species.electrons.start=ExB
    species.electrons.start = "ExB" needs a magnetic field: set plasma.B_x, B_y or B_z
cic line species.electrons.start=ExB plasma.B_y=1 species.electrons.drift_x=1
    species.electrons.start = "ExB" replaces the drift: take out drift_x, drift_y and drift_z
cic line species.electrons.amplitude=0.1 species.electrons.mode_x=0
    species.electrons: the perturbed mode has no wave number: set mode_x
cic plane species.electrons.amplitude=0.1 species.electrons.mode_x=0
    species.electrons: the perturbed mode has no wave number: set mode_x or mode_z
cic line species.electrons.amplitude=0.1 species.electrons.mode_z=1
    species.electrons.mode_z needs grid.dimensions = 2
cic line species.electrons.amplitude=0.1 species.electrons.mode_x=9
    species.electrons: mode (9, 0) has more than one wavelength per two cells, the cut-off of the
    mesh: refine it or lower the mode
cic plane species.electrons.amplitude=0.1 species.electrons.mode_z=-5
    species.electrons: mode (1, -5) has more than one wavelength per two cells
cic plane species.electrons.half_width=0.5 species.electrons.ripple=0.1 species.electrons.mode_x=5 \
    at_1_1 species.electrons.profile=layer
    species.electrons: mode (5, 0) has more than one wavelength per two cells
cic plane species.electrons.amplitude=0.1 species.electrons.mode_z=1 grid.boundary_z=wall
    species.electrons: mode (1, 1) would push particles through the walls: set mode_x or mode_z to 0
cic line perturbation.a.species=electron perturbation.a.amplitude=0.1
    perturbation.a.species = "electron" is the name of no species
cic line perturbation.a.species=electrons -> perturbation.a.amplitude = 0 perturbs nothing
cic line perturbation.a.species=electrons perturbation.a.amplitude=0.1 perturbation.a.mode_x=9
    perturbation.a: mode (9, 0) has more than one wavelength per two cells
cic line perturbation.a.species=electrons perturbation.a.amplitude=0.5 species.electrons.amplitude=0.5
    species.electrons: the amplitudes of its perturbations have the sum 1, above 0.9
)");
}

TEST_CASE("walls that do not fit are refused with the cure" * doctest::description("robust")) {
    check_refused(R"(
cic line boundary.potential_x_high=1
    there is no wall at x_high: set grid.boundary_x = "wall", or take out boundary.x_high,
    boundary.potential_x_high and boundary.particles_x_high
cic plane boundary.z_low=floating -> there is no wall at z_low: set grid.boundary_z = "wall"
cic plane boundary.particles_z_high=reflect
    there is no wall at z_high: set grid.boundary_z = "wall"
cic between_walls boundary.x_high=floating boundary.potential_x_high=-5
    boundary.potential_x_high = -5 belongs to a grounded wall; the charge of a floating one finds
    its own: take it out, or set boundary.x_high = "grounded"
cic between_walls boundary.x_low=floating gauss.sign=-1
    gauss.sign = -1 is not for floating walls: set boundary.x_low = "grounded"
cic plane boundary.z_low=floating box
    a floating wall that meets others at the corners of a box is not supported: make all walls
    grounded, or one direction periodic
cic between_walls species.electrons.emission=1
    species.electrons.emission needs boundary.particles_x_low = "source" and grid.boundary_x =
    "wall"
cic between_walls species.electrons.emission=1e9 boundary.particles_x_low=source
    species.electrons.emission = 1e+09 is 2.133e+09 particles in a step, more than 1e6: lower it, or
    raise density, which makes them heavier
cic between_walls species.electrons.emission_temperature=1e6 boundary.particles_x_low=source
    species.electrons.emission_temperature = 1e+06: a particle emitted with 8700 crosses the whole
    box in one step: lower it, or time.dt below 0.0006897
)");
}

TEST_CASE("theories are refused where they do not hold" * doctest::description("robust")) {
    check_refused(R"(
cic line wave time.end=0.5
    theory.compare = "wave" needs at least 10 steps: raise time.end above 1
cic line theory.mode_x=9
    the followed mode (9, 0) has more than one wavelength per two cells, the cut-off of the mesh:
    refine it or lower theory.mode_x and mode_z
cic plane wave theory.mode_z=5
    the followed mode (1, 5) has more than one wavelength per two cells
cic line theory.mode_z=1 -> theory.mode_z needs grid.dimensions = 2
cic between_walls wave -> theory.compare = "wave" needs periodic boundaries
cic plane wave species.electrons.profile=disk species.electrons.center_x=3 \
    species.electrons.center_z=3 species.electrons.half_width=1 \
    species.electrons.density=11.459155902616464
    theory.compare = "wave" needs uniform species, and 'electrons' is a disk
cic line wave plasma.B_y=1 species.electrons.temperature_x=1
    theory.compare = "wave" with a magnetic field needs the same temperature in all directions
    across it, and 'electrons' has temperature_x = 1, y: 0, z: 0
cic line wave plasma.B_y=1 species.electrons.drift_z=1
    theory.compare = "wave" with a magnetic field is for drifts along it, and 'electrons' drifts
    across: it would gyrate as a whole
cic line wave plasma.B_y=1 species.electrons.charge=0 species.ions.charge=0
    theory.compare = "wave" with a magnetic field is for charged species
cic line wave plasma.B_y=0.01 species.electrons.temperature_x=1 species.electrons.temperature_z=1
    theory.compare = "wave": the orbits of 'electrons' are 104.7 times the length 1/k across the
    field, more than the 100 to which harmonics are summed
cic line wave plasma.B_y=1 gauss.sign=-1
    theory.compare = "wave" with a magnetic field is for gauss.sign = 1
cic plane wave theory.model=mesh theory.mode_z=1
    theory.model = "mesh" needs a mode along x or along z, and not mode (1, 1)
cic line wave theory.model=mesh plasma.B_y=1
    theory.model = "mesh" has neither a magnetic field nor gauss.sign = -1: take "plasma"
cic line wave theory.model=mesh theory.mode_x=0
    theory.mode_x = 0 looks for the fastest growing mode with theory.model = "plasma", and not
    "mesh": name a mode, or take "plasma"
cic line wave theory.mode_x=0 grid.cells_x=2048
    theory.mode_x = 0 looks for the fastest growing of 1023 modes
cic ring.toml theory.mode_x=0 grid.cells_x=2048
    times the length 1/k across the field, more than the 100 to which harmonics are summed
cic line wave theory.mode_x=0 grid.cells_x=2
    theory.mode_x = 0 looks for the fastest growing of 0 modes
cic line wave no_charge
    no root of the dispersion relation was found for mode (1, 0): give theory.near a frequency to
    look at, or set theory.compare = "none"
cic line wave theory.model=mesh theory.mode_x=8
    no root of the dispersion relation was found for mode (8, 0)
cic between_walls traveling -> species.electrons.wave = "traveling" needs periodic boundaries
cic line traveling no_charge -> no root of the dispersion relation was found for mode (1, 0)
cic line traveling plasma.B_y=1
    species.electrons.wave = "traveling" is for waves without a magnetic field
cic plane theory.compare=diocotron
cic diocotron.toml species.ions.motion=fixed
cic diocotron.toml grid.boundary_x=wall
cic diocotron.toml plasma.B_x=1
    theory.compare = "diocotron" needs one species with profile = "layer" and no other, plasma.B_y
    alone, and walls in z only
cic diocotron.toml species.electrons.temperature_x=100
    theory.compare = "diocotron" is for cold particles, and the orbits of 'electrons' have the
    radius 0.5, above a tenth of its half_width of 1: lower its temperature, or raise plasma.B_y
cic diocotron.toml gauss.sign=-1 -> theory.compare = "diocotron" is for gauss.sign = 1
cic diocotron.toml theory.mode_x=0
    theory.compare = "diocotron" follows theory.mode_x, and not mode (0, 0)
cic diocotron.toml theory.mode_z=1
    theory.compare = "diocotron" follows theory.mode_x, and not mode (1, 1)
cic diocotron.toml species.electrons.center_z=7
cic diocotron.toml boundary.z_high=floating
cic diocotron.toml boundary.potential_z_low=1
    theory.compare = "diocotron" needs grounded walls of the same potential, and the layer half-way
    between them, at center_z = 8
cic diocotron.toml species.electrons.half_width=5
    theory.compare = "diocotron": mode 1 of a layer of half_width 5 and charge -1 does not grow:
    make it thinner, or change theory.mode_x
cic line theory.compare=sheath
cic sheath.toml boundary.particles_x_low=absorb species.electrons.emission=0 \
    species.ions.emission=0
cic sheath.toml boundary.x_high=grounded
cic sheath.toml boundary.particles_x_high=reflect
cic sheath.toml plasma.B_y=1
    theory.compare = "sheath" needs grid.dimensions = 1, no magnetic field, a floating source at
    x_low and a floating, absorbing wall at x_high
cic sheath.toml species.ions.emission=0.1
cic sheath.toml species.ions.charge=2 species.ions.density=0.025
    theory.compare = "sheath" needs two mobile species of opposite charge with the same emission
cic sheath.toml species.ions.mass=0.5
    no sheath forms at a floating collector unless ions are slower than electrons: take m_i / m_e
    above T_i / T_e, and T_i / T_e above 0
cic sheath.toml species.ions.mass=1.2 species.ions.emission_temperature=1e-3
    no potential falls from the source to a floating collector for such light and cold ions: raise
    m_i / m_e or T_i / T_e
cic line theory.compare=clouds
cic cloud_collision.toml species.ions.motion=fixed species.ions.charge=0
cic cloud_collision.toml grid.boundary_z=wall
cic cloud_collision.toml method.scheme=energy
cic cloud_collision.toml method.stencil=nine_point
cic cloud_collision.toml plasma.B_y=1
    theory.compare = "clouds" needs two species with profile = "point" in a periodic plane, the
    momentum scheme and the five-point stencil, and no magnetic field
cic cloud_collision.toml species.b.center_x=20
    theory.compare = "clouds" needs clouds apart along x, and both have center_x = 20
cic between_walls theory.compare=heating
cic plane theory.compare=heating species.electrons.temperature_x=1
    theory.compare = "heating" needs a warm plasma in one periodic
cic line theory.compare=heating
    theory.compare = "heating" needs uniform, charged, warm species, and 'electrons' has profile
    "uniform", charge -1 and temperature_x 0
cic thermal_heating.toml plasma.B_y=1
    theory.compare = "heating" needs the energy of v_x alone, and with a magnetic field the history
    has that of all directions: take out plasma.B_x, B_y and B_z
cic thermal_heating.toml species.ions.motion=mobile species.ions.temperature_x=1 \
    species.ions.drift_x=1
    theory.compare = "heating" needs species that drift together, and 'ions' has drift_x = 1,
    another 0
cic thermal_heating.toml species.electrons.amplitude=0.1
    theory.compare = "heating" is for the noise of particles, and the perturbation of 'electrons' is
    a wave beside it: take it out
)");
}

TEST_CASE("output that cannot be made is refused with the limit" * doctest::description("robust")) {
    check_refused(R"(
cic line output.modes=9
    output.modes = 9 is above the cut-off of the mesh, 8 modes: lower it or refine the mesh
cic between_walls output.modes=2 -> output.modes needs periodic x
cic line output.spectrum=true -> output.spectrum needs output.modes
cic line output.spectrum=true output.modes=4 time.end=0.3
    output.spectrum needs at least 8 steps, and there are 3: raise time.end above 0.8
)");
}

TEST_CASE("a fluid case without fluid is refused with what to add" *
          doctest::description("robust")) {
    check_refused(R"(
fluids -> there is no fluid: add a [region.<name>], or set setup.kind = "riemann"
fluids tube region.gas.shape=box region.gas.center_x=5 region.gas.half_x=1 region.gas.half_z=1
    no region contains a particle, so nothing can happen: put one on the mesh, from x = 0 to 1
fluids tube region.gas.shape=box region.gas.half_x=1
    region.gas is a box of half_x = 1 and half_z = 0: give both
fluids tube disk -> region.gas is a disk without radius: give it
fluids tube region.gas.ripple=0.1 -> region.gas.ripple = 0.1 needs shape = "above"
fluids tube region.gas.material=gold -> region.gas.material = "gold" is none of 'gas'
fluids tube inflow.material=gold boundary.x_low=inflow inflow.velocity_x=1
    inflow.material = "gold" is none of 'gas'
fluids sod region.more.density=1
    setup.kind = "riemann" makes its regions and materials from [left] and [right]: take out
    [region.*] and [material.*]
fluids sod material.more.gamma=1.4 -> take out [region.*] and [material.*]
fluids tube left.density=3 -> [left], [right] and setup.interface need setup.kind = "riemann"
fluids sod left.density=0 right.density=0
    there is no fluid: left.density and right.density are 0; give one of them
fluids sod setup.interface=1 -> setup.interface = 1 is not on the mesh, from 0 to 1
)");
}

TEST_CASE("a fluid mesh or a time step that cannot run is refused" *
          doctest::description("robust")) {
    check_refused(R"(
fluids box grid.cells_x=16384 grid.cells_z=16384 particles.per_cell_x=4
    2.684e+08 cells with 16 places for particles in each are 4.295e+09, more than 2e9: lower
    particles.per_cell_x and per_cell_z, or take fewer cells
fluids tube grid.low_x=1e8 -> grid.low_x = 1e+08 is 1e+10 cells from the origin, more than 1e9
fluids tube time.end=1e9 -> more than 1e9: lower time.end
fluids tube time.dt=0.02
    time.dt = 0.02: sound and flow cross 2.366 cells in a step, more than 1: lower it below 0.008452
flip tube flip.viscosity=1e10 -> more than 1e9: lower time.end, flip.viscosity or take larger cells
flip tube time.dt=0.02 flip.pressure=implicit region.gas.velocity_x=1
    time.dt = 0.02: the flow crosses 2 cells in a step
flip box time.dt=0.001 flip.viscosity=1
    flip.viscosity dt/(density dx^2) = 1.024 is above 0.5, where explicit viscosity blows up: lower
    it below 0.0004883
flip box time.dt=0.0001 flip.viscosity=1 flip.mass=consistent
    flip.viscosity dt/(density dx^2) = 0.1024 is above 0.07, where explicit viscosity with
    flip.mass = "consistent" blows up: lower it below 6.836e-05
fluids tube gravity.z=-1 -> gravity.z = -1 needs grid.cells_z of at least 2
)");
}

TEST_CASE("ends of a fluid mesh that do not fit are refused" * doctest::description("robust")) {
    check_refused(R"(
fluids box boundary.x_low=periodic
    boundary.x_low = "periodic" and boundary.x_high = "slip": a periodic direction has no ends; make
    both periodic or neither
fluids box boundary.z_high=periodic -> boundary.z_low = "slip" and boundary.z_high = "periodic"
fluids tube boundary.z_low=open boundary.z_high=open
    boundary.z_low = "open" needs grid.cells_z of at least 2: a row is periodic in z or slips
fluids box boundary.slide_x_low=1 -> boundary.slide_x_low = 1 needs boundary.x_low = "no_slip"
fluids box boundary.pressure_z_high=1 -> boundary.pressure_z_high = 1 needs boundary.z_high = "open"
fluids box boundary.x_high=inflow inflow.velocity_x=1
    boundary.x_high = "inflow" needs inflow.velocity_x below 0, into the mesh, and it is 1
fluids box boundary.z_low=inflow inflow.velocity_x=1
    boundary.z_low = "inflow" needs inflow.velocity_z above 0, into the mesh, and it is 0
fluids tube material.a.gamma=1.4 material.b.gamma=1.5 boundary.x_low=inflow inflow.velocity_x=1
    inflow.x_low has no material, and there are 2: give inflow.x_low.material one of 'a', 'b'
fluids tube boundary.x_high_pressure=1
    unknown parameter 'boundary.x_high_pressure'; did you mean 'boundary.pressure_x_high'?
fluids box inflow.velocity_x=1
    [inflow] needs an end with boundary = "inflow": set one, or take it out
)");
}

TEST_CASE("a rotation about an axis is refused where there is none or something would change it" *
          doctest::description("robust")) {
    check_refused(R"(
fluids box region.gas.velocity_theta=1
    velocity_theta and angular_velocity need an axis: set grid.geometry = "axisymmetric"; in the
    plane take a region with flow = "rotation"
fluids box boundary.z_low=inflow boundary.z_high=open inflow.velocity_z=1 inflow.angular_velocity=1
    velocity_theta and angular_velocity need an axis
flip box rings region.gas.angular_velocity=1 flip.viscosity=0.1
    flip.viscosity = 0.1 has a torque, and particles that turn about the axis keep their angular
    momentum
flip box rings region.gas.angular_velocity=1 boundary.x_high=no_slip
    boundary.x_high = "no_slip" would stop fluid that turns about the axis
fluids box rings region.gas.angular_velocity=1e50 -> is not between 1e-40 and 1e40 in size
fluids box rings region.gas.velocity_theta=x/0 -> is inf at x =
fluids box rings radial region.gas.angular_velocity=1 theory.compare=noh
    theory.compare = "noh" is stated for fluid that does not turn about the axis
fluids box region.gas.velocity_teta=1 -> did you mean 'region.gas.velocity_theta'?
fluids box theory.compare=inertial_wave
    theory.compare = "inertial_wave" is a wave about an axis: set grid.geometry = "axisymmetric"
fluids box rings theory.compare=inertial_wave
    theory.compare = "inertial_wave" needs fluid that turns: give region.gas.angular_velocity
fluids box rings region.gas.angular_velocity=1 theory.compare=inertial_wave gravity.z=-1
    theory.compare = "inertial_wave" is without gravity: take out gravity.z
fluids box rings region.gas.angular_velocity=1 theory.compare=inertial_wave boundary.z_high=open \
    boundary.z_low=open
    theory.compare = "inertial_wave" needs walls that slip: set boundary.z_low = "slip"
fluids box rings region.gas.velocity_theta=x*z theory.compare=inertial_wave
    theory.compare = "inertial_wave" needs a rotation that is the same at each z
fluids box rings region.gas.velocity_theta=x*z-x*z*z theory.compare=inertial_wave
    theory.compare = "inertial_wave" needs a rotation that is the same at each z
fluids box rings region.gas.velocity_theta=1/x theory.compare=inertial_wave
    theory.compare = "inertial_wave" needs a pressure that holds the column together
fluids box rings region.gas.velocity_theta=0*x theory.compare=inertial_wave
    theory.compare = "inertial_wave" has no wave: the angular momentum is the same everywhere
fluids box rings region.gas.velocity_theta=.1/x region.gas.hydrostatic=true
    region.gas.velocity_theta is
fluids box rings region.gas.velocity_theta=r region.gas.hydrostatic=true
    in formulas x is the distance from the axis, r that from the center of the region
fluids box gravity.z=-1 region.gas.hydrostatic=true region.gas.pressure=9 region.gas.density=1+x
    from way to way: take out hydrostatic, or let its density change along gravity alone
fluids box rings region.gas.angular_velocity=1 region.gas.density=1+z region.gas.hydrostatic=true
    take out hydrostatic, or let neither its density nor its rotation change along the axis
fluids box gravity.z=-1 region.gas.hydrostatic=true region.gas.pressure=9-z
    itself: give a number, or take out hydrostatic
fluids around gravity.x=-1 region.gas.hydrostatic=true region.gas.pressure=9
    needs walls that hold the fluid, and along x, a periodic direction, gravity lets it fall
fluids box rings region.gas.angular_velocity=1 theory.compare=inertial_wave theory.mode=20
    theory.compare = "inertial_wave" follows theory.mode = 20 half wavelengths along z, and 32 cells
    have no more than 16
)");
}

TEST_CASE("materials and pressures that cannot be are refused with the number" *
          doctest::description("robust")) {
    check_refused(R"(
fluids tube material.a.gamma=2 material.b.gamma=2 material.c.gamma=2 material.d.gamma=2 \
    material.e.gamma=2 material.f.gamma=2 material.g.gamma=2 material.h.gamma=2 material.i.gamma=2
    9 materials are more than the 8 that a cell can hold: use fewer
fluids tube material.a.gamma=1 material.a.p_infinity=2
    material.a.p_infinity = 2 needs gamma above 1: gamma = 1 is dust, without pressure
flip tube flip.pressure=implicit material.a.gamma=1
    material.a.gamma = 1 is dust, without pressure, and flip.pressure = "implicit" needs gamma above
    1
fluids tube material.a.gamma=1.0001 -> material.a.gamma = 1 is between 1 and 1.001
fluids tube region.gas.flow=wave material.a.gamma=1
    region.gas is dust, gamma = 1, and has no pressure for flow = "wave"
fluids box gravity.z=-4 region.gas.hydrostatic=true region.gas.pressure=1
    region.gas has the pressure -2.984 at x = 0.003906, z = 0.9961, and fluids here hold no
    tension: raise its pressure by more than that
fluids box water region.gas.pressure=0 sound -> , and fluids here hold no tension
fluids tube region.gas.flow=wave region.gas.amplitude=1
    region.gas.amplitude = 1 makes densities negative: take less than 1
fluids tube region.gas.flow=gaussian region.gas.width=0.1 region.gas.amplitude=-2
    region.gas.amplitude = -2 makes energies negative: take more than -1
fluids box region.gas.flow=rotation -> region.gas.flow = "rotation" needs a width above 0
fluids tube region.gas.flow=gresho region.gas.width=0.4
    region.gas.flow = "gresho" needs grid.cells_z of at least 2
fluids tube region.gas.flow=wave region.gas.mode=50
    region.gas.mode = 50 is not below the cut-off of the mesh, 50 wavelengths
fluids box region.gas.flow=overturn region.gas.center_z=1
    region.gas.flow = "overturn" needs center_z on the mesh, and it is 1
)");
}

TEST_CASE("what a method ignores is refused with what it needs" * doctest::description("robust")) {
    check_refused(R"(
pic tube flip.viscosity=0.1
    flip.viscosity = 0.1 is beyond pic: run the case with flip, or take it out
pic tube flip.pressure=implicit
    flip.pressure = "implicit" is beyond pic: run the case with flip, or take it out
pic tube boundary.x_low=no_slip
    boundary.x_low = "no_slip" needs viscosity: run the case with flip, or take "slip"
fluids tube flip.blend=0.9 -> flip.blend = 0.9 needs flip.transfer = "blend"
fluids tube flip.xpic_order=3 -> flip.xpic_order = 3 needs flip.transfer = "xpic"
fluids tube flip.confined=true -> flip.confined = true needs flip.density = "particles"
fluids tube flip.theta=0.6 -> flip.theta = 0.6 needs flip.pressure = "implicit"
fluids tube rezone.max_particles=40 -> rezone.max_particles = 40 needs rezone.steps above 0
fluids tube rezone.steps=1 rezone.min_particles=8 rezone.max_particles=15
    rezone.max_particles = 15 is below twice rezone.min_particles = 8
flip tube flip.mass=consistent flip.pressure=implicit
    flip.mass = "consistent" and flip.pressure = "implicit" do not go together
)");
}

TEST_CASE("comparisons of shocks and blasts that theory cannot answer are refused" *
          doctest::description("robust")) {
    check_refused(R"(
fluids tube theory.compare=riemann -> theory.compare = "riemann" needs setup.kind = "riemann"
fluids sod theory.compare=riemann around_x
    theory.compare = "riemann" needs ends in x, and they are periodic
fluids sod theory.compare=riemann gravity.x=1
    theory.compare = "riemann" is for fluid without gravity or trap
flip rotating_column.toml theory.mode=2
    theory.compare = "inertial_wave" follows theory.mode = 2, and region.gas.velocity_x has mode 1:
    make them the same
fluids piston.toml time.end=1.6
    theory.compare = "piston": the other end of the mesh is felt behind the shock from t = 1.305 on:
    lower time.end below that
fluids wall_shock.toml inflow.pressure=0.5 region.stream.pressure=0.5
    the other end of the mesh is felt behind the shock from t = 1.
fluids noh.toml time.end=0.9
    theory.compare = "noh": all gas has passed the shock at t = 0.75: lower time.end below that, or
    lengthen the mesh
fluids sedov.toml region.cold.pressure=0.01
    theory.compare = "sedov" is for a blast that does not feel the gas in front of it: at time.end
    the shock has the pressure
fluids tube theory.compare=wall_shock
    theory.compare = "wall_shock" needs gas that runs into a wall: give region.gas.velocity_x
fluids tube theory.compare=piston region.gas.velocity_x=-1 boundary.x_low=open
    the gas runs towards x_low, which is not a wall: set boundary.x_low = "slip"
fluids tube theory.compare=piston region.gas.velocity_x=-1 region.more.density=1
    theory.compare = "piston" needs a single region, uniform and everywhere
fluids tube theory.compare=piston region.gas.velocity_x=-1 material.a.gamma=1
    theory.compare = "piston" is for a gas, and gamma = 1 is dust
fluids tube theory.compare=piston region.gas.velocity_x=-1 region.gas.pressure=0
    theory.compare = "piston" needs gas with a pressure: give region.gas.pressure
fluids tube theory.compare=piston region.gas.velocity_x=-1 theory.frame_x=1
    is stated in the frame of the mesh: take out theory.frame_x and frame_z
fluids tube theory.compare=piston region.gas.velocity_x=-1 time.end=0.4
    the other end of the mesh is felt behind the shock from t = 0.3216 on: lower time.end
fluids box theory.compare=sedov
    theory.compare = "sedov" needs a cold region first, and one with an energy inside it; 0 have one
fluids box theory.compare=sedov material.a.gamma=3 hot
    theory.compare = "sedov" is known for gamma between 1 and 2, and it is 3
fluids box theory.compare=sedov hot region.hot.density=2
    needs one density, and region.hot has 2 where region.gas has 1: give both the same
fluids box theory.compare=sedov time.end=1 hot
    theory.compare = "sedov": at time.end the shock is at r = 1.004, and it meets x_low at 0.5:
    lower time.end, or move region.hot
fluids box theory.compare=collapse
    theory.compare = "collapse" needs rings, gas everywhere, in it a disk of liquid, and in that a
    disk of density 0, in this order
flip collapsing_cavity.toml gravity.z=-1
    theory.compare = "collapse" is for fluid without gravity or trap: take them out
fluids box region.gas.density=x-x -> region.gas has the density 0 at x =
fluids box region.gas.density=0 -> no region contains a particle
fluids box theory.compare=noh -> theory.compare = "noh" needs a region with flow = "radial"
fluids box theory.compare=noh radial
    theory.compare = "noh" is for cold gas, and pressure + p_infinity of region.gas is 1, above a
    hundredth of density speed^2, 1: lower it
fluids box theory.compare=noh region.gas.flow=radial region.gas.speed=-1
    theory.compare = "noh" needs region.gas.speed above 0, inward
)");
}

TEST_CASE("shocks and blasts that something else disturbs are refused with what to take out" *
          doctest::description("robust")) {
    check_refused(R"(
fluids wall_shock.toml gravity.x=-0.3
    theory.compare = "wall_shock" is for fluid without gravity or trap: take them out
fluids piston.toml gravity.trap=1
    theory.compare = "piston" is for fluid without gravity or trap: take them out
fluids wall_shock.toml region.stream.pressure=0.05
    theory.compare = "wall_shock": the inflow at x_high has the pressure 0, and region.stream there
    0.05: give both the same
fluids wall_shock.toml region.stream.density=2
    has the density 1, and region.stream there 2: give both the same
fluids piston.toml inflow.density=2 -> has the density 2, and region.gas there 1: give both the same
fluids wall_shock.toml inflow.velocity_x=-2
    has the velocity_x -2, and region.stream there -1: give both the same
fluids wall_shock.toml region.stream.velocity_z=0.5
    has the velocity_z 0, and region.stream there 0.5: give both the same
fluids wall_shock.toml material.x.gamma=3 inflow.material=x
    theory.compare = "wall_shock": the inflow at x_high is another gas than region.stream: give both
    the same material
fluids wall_shock.toml walls_z region.stream.velocity_z=0.5 inflow.velocity_z=0.5
    needs gas that runs straight at the wall: take out region.stream.velocity_z
fluids wall_shock.toml grid.cells_z=4 boundary.z_low=slip boundary.z_high=open
    needs gas that nothing else holds up or lets out: set boundary.z_high = "slip"
fluids sedov.toml gravity.z=-0.3
    theory.compare = "sedov" is for fluid without gravity or trap: take them out
fluids sedov.toml region.cold.velocity_x=0.2
    theory.compare = "sedov" needs uniform gas at rest, and region.cold is not that: take out its
    flow and velocities
fluids sedov.toml region.hot.flow=radial -> and region.hot is not that: take out its flow
fluids sedov.toml material.x.gamma=3 region.hot.material=x
    theory.compare = "sedov" needs one gas, and region.hot is another than region.cold: give both
    the same material
fluids sedov.toml region.far.shape=above region.far.center_z=0.9 region.far.density=3
    needs one density, and region.far has 3 where region.cold has 1: give both the same
fluids sedov.toml region.far.shape=above region.far.center_z=0.9 region.far.pressure=3
    and that of region.far is 3, more than 1/100 of it: lower it, or time.end
fluids sedov.toml region.cold.shape=above
    needs cold gas everywhere: set region.cold.shape = "everywhere"
fluids sedov.toml boundary.x_low=open
    theory.compare = "sedov" needs a blast on the mesh or on a wall that mirrors it: set
    boundary.x_low = "slip" and the center on it, or move the center
fluids sedov.toml region.hot.center_x=0.1
    at time.end the shock is at r = 0.7551, and it meets x_low at 0.1: lower time.end, or move
    region.hot
fluids sedov.toml around_x
    at time.end the shock is at r = 0.7551, and it meets its image beyond x_low at 0.5: lower
fluids noh.toml gravity.x=0.1
    theory.compare = "noh" is for fluid without gravity or trap: take them out
fluids noh.toml material.gas.p_infinity=1
    theory.compare = "noh" is for cold gas, and pressure + p_infinity of region.gas is 1, above a
    hundredth of density speed^2, 1: lower it
fluids noh.toml region.gas.velocity_x=0.1
    theory.compare = "noh" is of gas that falls to a place at rest: take out velocity_x and
    velocity_z of region.gas
fluids noh.toml region.gas.center_x=0.3 time.end=0.3
    theory.compare = "noh": all gas has passed the shock at t = 0.225: lower time.end below that
fluids noh.toml boundary.x_low=open
    theory.compare = "noh" needs its middle on the mesh, or on walls that mirror it: move
    region.gas.center_x or center_z, or set the ends there to "slip"
fluids noh.toml grid.cells_z=1 boundary.x_high=inflow boundary.z_high=slip inflow.pressure=0 \
    inflow.velocity_x=-2
    theory.compare = "noh": the inflow at x_high has the velocity_x -2, and region.gas there -1:
    give both the same
flip gresho.toml gravity.x=0.1
    theory.compare = "gresho" is for fluid without gravity or trap: take them out
)");
}

TEST_CASE("comparisons of waves and vortices that theory cannot answer are refused" *
          doctest::description("robust")) {
    check_refused(R"(
fluids tube theory.compare=rayleigh_taylor
    theory.compare = "rayleigh_taylor" needs grid.cells_z of at least 2
fluids box theory.compare=rayleigh_taylor
    theory.compare = "rayleigh_taylor" needs two regions, one everywhere and one above it
fluids box heavy theory.compare=rayleigh_taylor
    theory.compare = "rayleigh_taylor" needs periodic ends in x
fluids rayleigh_taylor.toml gravity.z=1
    density 2 above 1 with gravity.z = 1 does not overturn: turn one around
fluids box heavy theory.compare=rayleigh_taylor around_x gravity.z=-1 region.heavy.flow=overturn \
    region.heavy.mode=2 -> follows theory.mode = 1, and region.heavy.mode = 2: make them the same
fluids rayleigh_taylor.toml gravity.trap=0.1
    theory.compare = "rayleigh_taylor" is for gravity along z alone: take out gravity.x and
    gravity.trap
fluids rayleigh_taylor.toml gravity.trap=1 -> is for gravity along z alone
fluids rayleigh_taylor.toml region.upper.hydrostatic=false
    theory.compare = "rayleigh_taylor" needs fluid that begins at rest: set region.upper.hydrostatic
    = true
fluids rayleigh_taylor.toml region.upper.pressure=11
    theory.compare = "rayleigh_taylor" needs one pressure at the interface: region.lower has 10
    there, and region.upper has 11
fluids rayleigh_taylor.toml region.lower.pressure=2 region.upper.pressure=2
    theory.compare = "rayleigh_taylor" needs a pressure that carries the fluid up to the wall, and
    there it is 0: raise that of both regions
fluids box heavy theory.compare=rayleigh_taylor around_x gravity.z=-1 theory.mode=16
    follows theory.mode = 16, and 32 cells have no waves above 15
flip gravity_wave.toml region.air.velocity_x=0.1
    theory.compare = "gravity_wave" is of fluids that do not stream: take out the velocities and the
    flow of region.air
flip gravity_wave.toml gravity.z=1
    theory.compare = "gravity_wave": density 0.001 above 1 with gravity.z = 1 does not swing: turn
    one around
flip gravity_wave.toml material.water.gamma=1.4 material.water.p_infinity=0
    theory.compare = "gravity_wave" is of fluids that keep their volume, and with the sound of
    region.water the frequency changes by g/(k c^2) = 0.01137: raise its pressure or
    material.water.p_infinity
flip gravity_wave.toml region.air.pressure=11 -> needs one pressure at the interface
fluids box theory.compare=kelvin_helmholtz around_x shear region.gas.center_z=0.25
    needs the layer half-way between the walls, at center_z = 0.5
fluids box theory.compare=kelvin_helmholtz around_x shear region.gas.width=0.3
    mode 1 of a layer of half-width 0.3 does not grow: make it thinner, or lower theory.mode
fluids box theory.compare=kelvin_helmholtz around_x shear gravity.z=-1
    theory.compare = "kelvin_helmholtz" is for fluid without gravity or trap
fluids kelvin_helmholtz.toml region.upper.density=2
    theory.compare = "kelvin_helmholtz" is for streams of one density and pressure in one layer of
    shear, and region.upper is not like region.lower: give both the same density
fluids kelvin_helmholtz.toml gravity.trap=1 -> is for fluid without gravity or trap
fluids kelvin_helmholtz.toml region.upper.velocity_x=1
    theory.compare = "kelvin_helmholtz": region.upper moves with 1, 0 beside its layer of shear: set
    theory.frame_x to the first, and the second to 0
fluids kelvin_helmholtz.toml region.upper.width=0.1 -> region.upper is not like region.lower
fluids box theory.compare=kelvin_helmholtz around_x
    theory.compare = "kelvin_helmholtz" needs a region with flow = "shear"
fluids box theory.compare=wave sound -> theory.compare = "wave" needs periodic ends in x
fluids around theory.compare=wave region.gas.flow=wave region.gas.amplitude=0
    theory.compare = "wave" needs a wave: give region.gas.amplitude
fluids around theory.compare=wave sound region.gas.pressure=0
    theory.compare = "wave" needs a gas with sound: give region.gas.pressure
fluids around theory.compare=wave sound gravity.x=0.1
    theory.compare = "wave" is for fluid without gravity or trap
flip around theory.compare=wave sound flip.viscosity=0.001
    theory.compare = "wave" is for sound that nothing damps: take out flip.viscosity
fluids around theory.compare=rest gravity.x=1
    theory.compare = "rest" needs walls that hold the fluid, and it falls for ever along a periodic
    direction
fluids box theory.compare=rest boundary.z_high=open
    theory.compare = "rest" needs ends that hold the fluid: set boundary.z_high = "slip"
fluids around theory.compare=wave sound region.gas.velocity_x=1
    theory.compare = "wave": the gas moves with 1: set theory.frame_x to that
fluids around theory.compare=diffusion gaussian dust time.dt=0
    theory.compare = "diffusion" needs steps of one length: set time.dt
fluids around theory.compare=diffusion gaussian dust region.gas.velocity_x=0
    theory.compare = "diffusion" needs a flow over the mesh: give region.gas.velocity_x
fluids around theory.compare=diffusion gaussian
    theory.compare = "diffusion" needs dust, whose energy has no pressure: set gamma = 1
fluids around theory.compare=diffusion gaussian dust region.gas.width=0.2
    needs a mesh ten times as long as region.gas.width = 0.2, and it is 1
fluids around theory.compare=diffusion gaussian dust gravity.x=0.1
    theory.compare = "diffusion" is for fluid without gravity or trap: take them out
fluids around theory.compare=ringing
    theory.compare = "ringing" needs a seed: give region.gas.noise
fluids ringing.toml gravity.x=0.001
    theory.compare = "ringing" is for fluid without gravity or trap: take them out
fluids ringing.toml gravity.trap=0.001
    theory.compare = "ringing" is for fluid without gravity or trap: take them out
fluids around theory.compare=gresho gresho region.gas.speed=0
    theory.compare = "gresho" needs a flow: give region.gas.speed
fluids around theory.compare=gresho gresho region.gas.velocity_x=1 region.gas.pressure=9
    the vortex moves with 1, 0: set theory.frame_x and frame_z to that
fluids box theory.compare=rotation
    theory.compare = "rotation" needs a region with flow = "rotation"
fluids rotating_disk.toml gravity.trap=0
    theory.compare = "rotation" needs a trap that bends all paths to circles: set gravity.trap =
    (speed/width)^2 = 1
fluids rotating_disk.toml region.disk.speed=0.15 -> set gravity.trap = (speed/width)^2 = 0.25
fluids rotating_disk.toml gravity.x=0.1
    theory.compare = "rotation" is without gravity: take out gravity.x and gravity.z
fluids rotating_disk.toml material.dust.gamma=1.4 region.disk.pressure=0.1
    theory.compare = "rotation" is for dust, and region.disk has a pressure, which drives it apart
fluids rotating_disk.toml region.disk.center_x=0.1
    theory.compare = "rotation" needs a disk that stays in the middle of the mesh
)");
}

TEST_CASE("comparisons of dams and cavities and impacts that have no answer are refused" *
          doctest::description("robust")) {
    check_refused(R"(
fluids box dam gravity.z=0 -> theory.compare = "dam_break" needs gravity.z below 0, and it is 0
fluids box dam region.gas.center_z=0.5
    needs the water in the corner of x_low and z_low, and it is 0.1 away
fluids box dam region.gas.half_x=0.5 region.gas.center_x=0.5
    needs room beyond the water: lower region.gas.half_x below 0.5
fluids box dam boundary.z_low=open -> needs a wall at x_low and a floor at z_low: set both to "slip"
fluids box dam gravity.x=0.1
    theory.compare = "dam_break" is for water that gravity.z alone pulls: take out gravity.x and
    gravity.trap
fluids box dam gravity.trap=0.1 -> take out gravity.x and gravity.trap
flip cavity.toml gravity.z=-0.1
    theory.compare = "cavity" is for fluid without gravity or trap: take them out
fluids box theory.compare=cavity -> theory.compare = "cavity" needs no_slip walls on all sides
flip box theory.compare=cavity no_slip -> needs a lid that moves: set boundary.slide_z_high above 0
flip box theory.compare=cavity no_slip boundary.slide_z_high=1
    is published for density speed length/flip.viscosity = 100, and it is infinite: set
    flip.viscosity = 0.01
flip box theory.compare=cavity no_slip boundary.slide_z_high=1 flip.viscosity=0.1
    and it is 10: set
flip box theory.compare=cavity no_slip boundary.slide_z_high=1 flip.viscosity=0.01 grid.length_x=2
    is for a square, and the mesh is 2 x 1
fluids box theory.compare=impact
    theory.compare = "impact" needs two materials, and the one that is hit in a region of shape
    "box"
)");
}

TEST_CASE("a mesh or a run that grains cannot have is refused" * doctest::description("robust")) {
    check_refused(R"(
grains disks periodic boundary.x_low=slip
    grid.periodic_x = true leaves no walls at the ends of x: set boundary.x_low and boundary.x_high
    to "open"
grains body periodic grid.cells_x=7 grid.length_x=0.7
    grid.cells_x = 7 is too few for a periodic mesh: take at least 8
grains disks grid.low_y=1e9
    the mesh begins 2e+10 cells from the origin, more than 1e9, where places are lost to round-off:
    move grid.low_x and low_y nearer to 0
grains disks time.alpha=1e-9
    the run would take 7.538e+09 steps, more than 1e9: raise time.alpha or lower time.end
mpm_explicit disks time.dt=1
    time.dt = 1 is above alpha h/(c_p + |v|) = 0.003317: lower it, or raise time.alpha
grains disks time.end=1e30 -> steps, more than 1e9: raise time.alpha or lower time.end
grains body grid.cells_x=16000 grid.cells_y=8000 grid.particles_per_side=16
    32768000000 particles are more than 2e9: lower grid.particles_per_side
grains body grid.cells_x=1600 output.fringes_interval=1 grid.cells_y=800 output.pixels_per_cell=64
    output.pixels_per_cell = 64 makes rasters of 5.243e+09 pixels, more than 5e7: take fewer
)");
}

TEST_CASE("grains that overlap are refused with their names and how deep" *
          doctest::description("robust")) {
    check_refused(R"(
grains disks grain.right.x=0.7
    grains 'left' and 'right' overlap by 0.05, 1 cells: move them apart or make them smaller
grains disks grain.right.x=0.675 grain.right.shape=box grain.right.width=0.3 \
    grain.right.height=0.3
    grains 'left' and 'right' overlap by 0.025, 0.5 cells: move them apart or make them smaller
grains disks polygon grain.right.shape=polygon grain.right.x=0.7
    grains 'left' and 'right' overlap by 0.0433, 0.866 cells: move them apart or make them smaller
grains disks polygon grain.left.vertices='0.1 0.1, 0.6 0.1, 0.6 0.5, 0.4 0.3, 0.1 0.5' \
    grain.right.x=0.75
    grains 'left' and 'right' overlap by 0.05, 1 cells: move them apart or make them smaller
grains disks periodic grain.left.x=0.15 grain.right.x=1.1 grain.right.y=0.31
    grains 'left' and 'right' overlap by 0.1498, 2.996 cells: move them apart or make them smaller
grains disks periodic grain.right.x=2.3
    grain 'right' reaches from x = 2.1 to 2.5, more than its length of 1.2 beyond the periodic mesh:
    move it by whole lengths
grains mesh end left pack.row.radius=0.1 rows
    grains 'left' and 'row_g0001' overlap by 0.09384, 1.877 cells: move them apart or make them
    smaller
grains mesh end pack.row.radius=0.1 pack.row.spacing_x=0.15 rows
    grains 'row_g0001' and 'row_g0002' overlap by 0.05, 1 cells: move them apart or make them
    smaller
grains mesh end periodic grain.bar.shape=box grain.bar.x=0.6 grain.bar.y=0.3 grain.bar.width=1.3
    grain 'bar' is longer than the periodic mesh: shorten it to 1.2
grains mesh end one_disk grain.p_g0001.x=0.6 grain.p_g0001.y=0.3
    two grains are called 'p_g0001': rename one of them
grains compressed.toml grain.plate.y=0.769 -> grains 'plate' and 'disk_g0015' overlap by
)");
}

TEST_CASE("grains that cannot be filled or held are refused" * doctest::description("robust")) {
    check_refused(R"(
grains mesh -> there is no grain: add a [grain.<name>] or a [pack.<name>]
grains -> there is no grain
grains plates material.default.law=rigid
    all grains are rigid: give one a material that can be strained
grains disks grain.left.radius=0.04
    grain 'left' is 1.6 cells thin, below 2: refine the mesh to cells of at most 0.04, or take a
    larger grain
grains disks grain.left.shape=box grain.left.width=0.3 grain.left.height=0.08 grain.left.angle=30
    grain 'left' is 1.6 cells thin
grains disks polygon grain.left.vertices='0.1 0.2, 0.5 0.2, 0.3 0.25'
    grain 'left' is 1 cells thin
grains disks pack.p.radius=0.01 pack.p.x=0.6 pack.p.y=0.05 pack.p.rows=1
    grain 'p_g0001' is 0.4 cells thin
grains disks polygon \
    grain.left.vertices='0.2 0.2, 0.5 0.2, 0.5 0.201, 0.201 0.201, 0.201 0.5, 0.2 0.5'
    grain 'left' is so thin that it fills no quarter of what a particle stands for: refine the
    mesh, or make it wider
grains disks grain.left.x=0.15
    grain 'left' reaches from (-0.05, 0.1) to (0.35, 0.5), beyond the mesh from (0, 0) to (1.2,
    0.6): move the grain or widen the mesh
grains disks grain.right.x=1.1 -> grain 'right' reaches from (0.9,
grains disks periodic grain.left.y=0.1 -> grain 'left' reaches from (0.15, -0.1)
grains disks grid.low_y=-0.3 -> beyond the mesh from (0, -0.3) to
grains disks polygon grain.left.vertices='0.2 0.2, 0.5 0.2'
    [grain.left]: a polygon of 2 corners: give at least 3 and at most 1000
grains disks polygon grain.left.vertices='0.2 0.2, 0.5 0.5, 0.5 0.2, 0.2 0.5'
    [grain.left]: the side from corner 1 to 2 of a polygon meets the side from corner 3 to 4: list
    the corners in order around the grain
grains disks polygon grain.left.vertices='0.2 0.2, 0.3 0.3, 0.4 0.4'
    [grain.left]: the 3 corners of a polygon lie on a line: it has no area
grains disks polygon grain.left.vertices='0.2 0.2, 0.2 0.2, 0.4 0.4'
    [grain.left]: corners 1 and 2 of a polygon are the same point: leave one out
grains disks polygon grain.left.vertices='0 0, 1 0 2, 1 1'
    grain.left.vertices: ' 1 0 2' is not a corner: write "x y, x y, x y"
grains disks polygon grain.left.vertices='0 0, 1, 1 1' -> grain.left.vertices: ' 1' is not a corner
grains disks polygon grain.left.vertices='0 0, nan 0, 1 1'
    grain.left.vertices: ' nan 0' is not a corner
grains disks polygon grain.left.vertices='0 0, 1e999 0, 1 1'
    grain.left.vertices: ' 1e999 0' is not a corner
grains disks polygon grain.left.vertices='0 0, 1e200 0, 1 1'
    [grain.left]: corner 2 is not at a finite place: give two numbers below 1e100
grains disks grain.left.vertices='0 0, 1 0, 1 1'
    [grain.left]: vertices belong to shape = "polygon": set it, or take them out
)");
}

TEST_CASE("materials and motions that do not go together are refused" *
          doctest::description("robust")) {
    check_refused(R"(
grains disks grain.left.material=steel
    [grain.left]: there is no [material.steel]; add it, or name another material
grains disks grain.left.material=
    [grain.left]: there is no [material.]; add it, or name another material
grains disks pack.p.material=steel
    [pack.p]: there is no [material.steel]; add it, or name another material
grains disks material.default.law=drucker_prager material.default.dilatancy_angle=40
    [material.default]: dilatancy_angle = 40 is above friction_angle = 30: flow would make energy;
    take at most the friction angle
grains disks grain.left.control=force_x
    grain 'left' has control = "force_x" and is not rigid: give it a material with law = "rigid"
grains disks grain.left.swing_y=0.1
    grain 'left' has stop, swing or table and is not rigid: give it a material with law = "rigid"
grains disks grain.left.stop=1 -> has stop, swing or table and is not rigid
grains plates grain.top.spin=1
grains plates grain.top.profile=wave
    grain 'top' is rigid and moves without turning: take out spin and profile
grains disks grain.left.profile=bar
    grain 'left' has a profile of its velocity, which is for boxes: set shape = "box"
)");
}

TEST_CASE("packs that cannot be made are refused with the cure" * doctest::description("robust")) {
    check_refused(R"(
grains mesh pack.p.kind=random packed
    [pack.p]: the box is full with 17 disks and a solid fraction of 0.7418: ask for fewer, or make
    the box larger
grains mesh pack.p.kind=loose packed
    [pack.p]: the box is full with 10 disks and a solid fraction of 0.4363: ask for fewer
grains mesh pack.p.kind=random pack.p.height=1e6
    [pack.p]: a region of 1 by 1e+06 is more than a hundred times the mesh
grains mesh pack.p.kind=random pack.p.radius_min=0.4 pack.p.radius_max=0.4 pack.p.height=0.6
    [pack.p]: a box of 1 by 0.6 is too small for disks 0.8 wide: it must be as high, and 1 times as
    wide
grains mesh pack.p.kind=random pack.p.radius_min=0.2 pack.p.radius_max=0.1
    [pack.p]: the largest radius of a pack, 0.1, must be 1 to 100 times the least, 0.2
grains mesh pack.p.columns=1 pack.p.rows=2
    [pack.p]: 2 rows of 1 disks: give at least one disk in each row, and at most 1e6
grains mesh pack.p.columns=10000 pack.p.rows=10000 -> [pack.p]: 10000 rows of 10000 disks
grains mesh pack.p.sides=2 one_disk -> [pack.p]: a regular polygon of 2 sides: give 3 to 1000
grains mesh pack.p.file=pack.txt
    [pack.p]: file belongs to kind = "file": set it, or take file out
grains mesh pack.p.kind=file -> [pack.p]: kind = "file" needs the name of a file: set file
grains mesh pack.p.kind=file pack.p.file=nowhere.txt -> [pack.p]: nowhere.txt: there is no such file
grains mesh pack.p.kind=file pack.p.file=foreign -> [pack.p]: foreign: is a folder, not a file
grains mesh pack.p.kind=file pack.p.file=dangling -> [pack.p]: dangling: there is no such file
grains mesh output.pack=true grain.a_name_that_goes_on_and_on_for_forty_one_letters.x=0.3 \
    grain.a_name_that_goes_on_and_on_for_forty_one_letters.y=0.3
    grain 'a_name_that_goes_on_and_on_for_forty_one_letters' has a name of 48 letters, and pack.txt
    takes 40: shorten it, or set output.pack = false
)");
}

TEST_CASE("bonds that nothing can hold are refused with their names" *
          doctest::description("robust")) {
    check_refused(R"(
grains disks joint
    [bond.joint]: 'left' and 'right' do not touch: put them within a quarter of a cell
grains disks bond.joint.tension=1 -> [bond.joint]: '*' and '*' do not touch
grains disks pair.one.friction=0.2 pair.one.a=glass
    [pair.one]: there is no [material.glass]; add it, or name another material
grains disks pair.one.friction=0.2 pair.one.b= -> [pair.one]: there is no [material.]
grains disks material.glass.E=1e4 pair.one.a=glass pair.two.b=glass
    [pair.two]: 'default' and 'glass' are in [pair.one], too: take one out
grains disks pair.one.friction=-1 -> 'pair.one.friction' = -1 is out of range
grains disks bond.joint.a=nobody
    [bond.joint]: there is no grain 'nobody'; name one of the case, or "*" for all
grains disks bond.joint.a= -> [bond.joint]: there is no grain ''
grains disks touching bond.joint.a=left bond.joint.b=left
    [bond.joint]: 'left' and 'left' do not touch
grains plates grain.top.y=0.15 grain.disk.y=0.4 bond.joint.a=top bond.joint.b=bottom
    [bond.joint]: 'top' and 'bottom' are rigid and need no bond: take it out
grains disks touching joint bond.more.tension=1
    [bond.more]: 'left' and 'right' are bonded already: let one bond name both
)");
}

TEST_CASE("comparisons of grains are refused where theory does not hold" *
          doctest::description("robust")) {
    check_refused(R"(
grains disks theory.compare=rebound time.end=1 grain.left.radius=0.19
grains disks theory.compare=rebound time.end=1 grain.left.velocity_x=-0.2 \
    grain.right.velocity_x=0.1
grains disks theory.compare=rebound time.end=1 grain.left.velocity_y=0.1
grains disks theory.compare=rebound time.end=1 material.soft.E=1e3 grain.left.material=soft
grains mesh left theory.compare=rebound
grains disks theory.compare=rebound grain.left.shape=box
    theory.compare = "rebound" needs two equal disks of one material that meet head on
grains disks theory.compare=rebound time.end=0.4
    theory.compare = "rebound": the disks meet at t = 0.5, and the run ends at 0.4: raise time.end
mpm_explicit block_at_rest.toml time.end=1e-5 output.history_steps=1
    theory.compare = "rest" needs at least 10 rows of history, and there would be 1: raise time.end
    or lower time.alpha
mpm_explicit block_at_rest.toml time.end=1e-3
    theory.compare = "rest" needs at least 10 rows of history, and there would be 0: raise time.end
    or lower output.history_steps
mpm_explicit block_at_rest.toml theory.compare=collapse
    theory.compare = "collapse" needs no plate: the floor is the wall boundary.y_low
mpm_explicit column_collapse.toml pack.g.x=68
    theory.compare = "collapse" needs a column in the lower left corner of the mesh, at a wall
    boundary.x_low: it begins at x = 68 and y = 0, and the mesh at 0 and 0
mpm_explicit column_collapse.toml contact.friction=0
    theory.compare = "collapse" needs boundary.y_low = "frictional", and boundary.friction and
    contact.friction above 0
mpm_explicit column_collapse.toml load.gravity_x=0.3
    theory.compare = "collapse" needs load.gravity_y below 0 alone, and load.damping = 0
grains body theory.compare=bar boundary.x_low=slip
grains body theory.compare=bar bar
grains body theory.compare=bar boundary.x_low=frictional bar
grains body theory.compare=bar boundary.x_low=slip grain.body.profile=bar
    theory.compare = "bar" needs boxes with profile = "bar", an amplitude, and boundary.x_low =
    "slip" or "stick"
grains body theory.compare=bar boundary.x_low=slip grain.body.width=0.6 bar
    theory.compare = "bar" needs a bar that begins at the wall, at x = 0, not at 0.1
grains body theory.compare=bond boundary.x_low=slip bar
    theory.compare = "bond" needs two boxes and a [bond.<name>] between them
grains body theory.compare=standing_wave wave
grains body theory.compare=standing_wave slip bar
grains disks theory.compare=standing_wave slip
    theory.compare = "standing_wave" needs one box with profile = "wave", an amplitude, and all
    walls "slip"
grains body theory.compare=standing_wave slip grain.body.height=0.3 wave
    theory.compare = "standing_wave" needs a box that fills the mesh: make it 0.8 by 0.4
grains body theory.compare=oscillator slip wave
    theory.compare = "oscillator" needs grid.cells_x = 2, method.frozen = true, and linear FLIP
grains oscillator.toml material.default.viscosity=1e-3
    theory.compare = "oscillator" is with a body without viscosity: set
    material.default.viscosity = 0
grains vibrating_bar.toml material.default.viscosity=1e-3
    theory.compare = "bar" is with a body without viscosity: set material.default.viscosity
    = 0
grains disks material.default.viscosity=-1e-3
    'material.default.viscosity' = -0.001 is out of range; allowed: >= 0
grains oscillator.toml method.frozen=false
grains oscillator.toml method.shape=quadratic
    theory.compare = "oscillator" needs grid.cells_x = 2, method.frozen = true
grains body theory.compare=block load.gravity_x=1 load.gravity_y=-1
grains incline_block.toml load.gravity_x=0
    theory.compare = "block" needs one grain, a rigid plate, and an inclined gravity: load.gravity_x
    not 0, load.gravity_y below 0
grains rolling_cylinder.toml grain.plate.y=0.35
    theory.compare = "rolling" needs a rigid plate below the grain: turn the case, so that x is along the plate
grains rolling_cylinder.toml load.gravity_y=1
    theory.compare = "rolling" needs one grain, a rigid plate, and an inclined gravity:
    load.gravity_x not 0, load.gravity_y below 0
grains incline_block.toml grain.block.velocity_x=1
    theory.compare = "block" is of a grain that starts at rest: take out velocity_x, velocity_y,
    spin and amplitude of 'block'
grains rolling_cylinder.toml grain.cylinder.spin=5
    theory.compare = "rolling" is of a grain that starts at rest: take out velocity_x, velocity_y,
    spin and amplitude of 'cylinder'
grains incline_block.toml grain.plate.velocity_x=0.1
    theory.compare = "block" is of a plate at rest: take out what moves 'plate'
grains incline_block.toml grain.block.shape=disk
    theory.compare = "block" is of a block, and a disk rolls: set theory.compare = "rolling"
mpm_implicit disks theory.compare=compression
    theory.compare = "compression" needs a rigid grain that presses the others
grains incline_block.toml grain.block.y=0.3
    theory.compare = "block" needs a grain on its plate, and 'block' begins 0.05 above: lower it
grains incline_block.toml grain.block.height=0.3 grain.block.y=0.3 grain.block.width=0.1 contact.friction=0.5
    theory.compare = "block" is of a block that does not topple, and friction turns this one over
    its lower edge: its base reaches 0.05 beyond its center, and has to reach farther than 0.075
grains incline_block.toml grain.block.shape=polygon grain.block.sides=6 grain.block.radius=0.2 \
    grain.block.y=0.32320508075689 contact.friction=0.6 load.gravity_x=7
    theory.compare = "block" is of a block that does not topple, and friction turns this one over
    its lower edge: its base reaches 0.1 beyond its center, and has to reach farther than 0.1039
grains bonded_bar.toml grain.right.amplitude=0.2
    theory.compare = "bond" needs one material, mode and amplitude of all boxes
grains vibrating_bar.toml grain.bar.mode=10 material.default.nu=0.3
    theory.compare = "bar" is of a thin bar, and this one, whose height is 3.125
mpm_implicit billet.toml grain.top.velocity_y=1e-3
    theory.compare = "billet": plate 'top' moves away from
grains disks time.energy_limit=0.5
    time.energy_limit = 0.5 is what a run begins with: raise it above 1, or set 0 for none
grains incline_block.toml theory.compare=rolling -> theory.compare = "rolling" needs a disk
grains mesh left theory.compare=disk
grains disks theory.compare=disk
grains plates theory.compare=disk grain.disk.shape=box
    theory.compare = "disk" needs a disk, first in the case, and rigid plates, at most 16
grains hertz.toml load.gravity_y=-1
    theory.compare = "hertz" is with bodies without weight: take out load.gravity_x and load.gravity_y
grains diametral_disk.toml load.gravity_x=-1 -> is with bodies without weight
grains standing_wave.toml load.gravity_y=1e-6 -> is with bodies without weight
mpm_implicit billet.toml load.gravity_y=-1 -> is with bodies without weight
grains hertz.toml contact.friction=0.1
grains hertz.toml grain.cylinder.radius=0.39
    theory.compare = "hertz" needs an elastic disk between two rigid plates that touch it below and
    above, without friction
grains plates theory.compare=hertz grain.disk.shape=box
    theory.compare = "hertz" needs a disk, first in the case, and rigid plates, at most 16
grains disks theory.compare=yield
    theory.compare = "yield" needs a grain of a material with law = "j2", and 'left' is of another:
    set theory.grain
mpm_explicit disks theory.compare=yield material.soft.law=j2 grain.right.material=soft
    needs a grain of a material with law = "j2", and 'left' is of another
mpm_implicit disks theory.compare=yield material.soft.law=j2 grain.right.material=soft \
    solver.kind=newton_krylov
    needs a grain of a material with law = "j2", and 'left' is of another
mpm_implicit mesh end left theory.compare=yield material.default.law=j2 grain.left.velocity_x=0 \
    solver.kind=newton_krylov
mpm_explicit mesh end left theory.compare=yield material.default.law=j2 grain.left.velocity_x=0
mpm_explicit plates theory.compare=yield material.default.law=j2 grain.disk.velocity_x=0 grain.top.velocity_y=-0.1
    theory.compare = "yield" measures shares of the energy at the start, and nothing that can be
    strained moves then: give it a velocity
grains plates theory.compare=disk theory.grain=nobody -> theory.grain: there is no grain 'nobody'
grains plates theory.compare=disk theory.plate=nobody -> theory.plate: there is no grain 'nobody'
grains plates theory.compare=disk theory.grain=top
    theory.grain: 'top' is rigid: name another grain
grains plates theory.compare=disk theory.plate=disk
    theory.plate: 'disk' is not rigid: name another grain
)");
}

TEST_CASE("schemes and solvers of mpm_implicit that do not go together are refused" *
          doctest::description("robust")) {
    check_refused(R"(
mpm_implicit rebound.toml material.default.law=j2
    [material.default] can yield, and solver.kind = "projected_cg" is for elastic grains: set
    solver.kind = "newton_krylov"
mpm_implicit rebound.toml material.default.law=drucker_prager
    [material.default] can yield, and solver.kind = "projected_cg"
mpm_implicit rebound.toml method.volumes=updated
    method.volumes = "updated" makes the step nonlinear: set solver.kind = "newton_krylov"
mpm_implicit vibrating_bar.toml method.mass=lumped
    theory.compare = "bar" knows the damping of the consistent mass matrix only: set method.mass =
    "consistent", or compare with "oscillator"
mpm_implicit oscillator.toml grid.cells_x=4 grid.cells_y=4
    theory.compare = "oscillator" needs grid.cells_x = 2, method.frozen = true, and linear FLIP
mpm_implicit rebound.toml theory.compare=billet
mpm_implicit billet.toml contact.friction=0.1
mpm_implicit billet.toml grain.billet.height=0.3 grain.billet.angle=1
mpm_implicit billet.toml grain.billet.shape=disk grain.billet.radius=0.2
mpm_implicit billet.toml grain.top.velocity_y=0
mpm_implicit billet.toml theory.plate=bottom
    theory.compare = "billet" needs one upright box between two rigid plates without friction, of
    which one moves along y
mpm_implicit billet_plastic.toml material.default.hardening=1
mpm_implicit billet.toml material.default.law=drucker_prager newton
    theory.compare = "billet" knows what is elastic, and what has law = "j2" and hardening = 0:
    change [material.default]
mpm_implicit billet.toml grain.top.width=0.5
    theory.compare = "billet": plate 'top' does not cover a whole side of 'billet': make it wider,
    and let them touch
mpm_implicit billet.toml grain.top.y=0.549 grain.billet.height=0.39 grain.billet.y=0.295
    plate 'top' does not cover a whole side of 'billet'
mpm_implicit billet_plastic.toml grid.cells_x=12 grid.length_x=0.6 grid.periodic_x=true \
    grain.billet.x=0.3 grain.top.x=0.3 grain.top.width=0.6 grain.bottom.x=0.3 grain.bottom.width=0.6
    theory.compare = "billet" knows no limit for a block that cannot widen: make it narrower
mpm_explicit plate_holds.toml grain.top.stop=0
mpm_explicit plate_holds.toml time.end=5
mpm_explicit plate_holds.toml material.default.law=j2
    theory.compare = "hold" needs an elastic block, and a plate that has come to rest, at stop +
    load.rise, when half of the run is over
mpm_explicit cyclic_plate.toml grain.top.swing_y=0
mpm_explicit cyclic_plate.toml grain.top.stop=0
mpm_explicit cyclic_plate.toml time.end=6
    theory.compare = "cycle" needs a plate with a swing_y, and two whole periods after it has come
    to rest otherwise
mpm_explicit cyclic_plate.toml grain.block.width=0.8
mpm_explicit cyclic_plate.toml grain.top.velocity_y=-2e-4
mpm_explicit cyclic_plate.toml grain.top.swing_y=2e-3
    theory.compare = "cycle" of what yields needs a block as wide as the mesh, between rollers or
    periodic, and a velocity that presses it before by a stress above 2/3 of yield_stress
mpm_implicit billet.toml theory.plate=middle -> theory.plate: there is no grain 'middle'
)");
}

TEST_CASE("a plasma that cannot run is refused with the numbers and the cure" *
          doctest::description("robust")) {
    check_refused(R"(
plasmas time.dt=1e-9 time.end=2
    time.end / time.dt is 2e+09 steps, more than 1e9: raise time.dt or lower time.end
plasmas time.dt=1e-30 time.end=1e30
    time.end / time.dt is 1e+60 steps, more than 1e9: raise time.dt or lower time.end
plasmas grid.boundary_z=periodic
plasmas grid.boundary_z=reflecting
    the Harris sheet needs grid.boundary_z = "wall"
plasmas harris.normal_field=0.05
    harris.normal_field = 0.05 B0 makes a tail, which has two ends: set grid.boundary_x = "reflecting"
plasmas grid.boundary_x=reflecting harris.normal_field=0.1
    the field lines of the tail are turned by 1.28 at the walls, more than 1: lower harris.normal_field or
plasmas grid.boundary_x=reflecting harris.thickness=3 harris.normal_field=0.1
    the tail is 4.596 d_i thick at one end and does not fit between walls 12.8 d_i apart: lower
    harris.normal_field or grid.length_x
plasmas theory.near=-1 -> 'theory.near' = -1 is out of range
plasmas grid.cells_z=63
    grid.cells_z = 63 is odd: the flux is measured on the row z = 0, so make it even
plasmas harris.thickness=4
    harris.thickness = 4 d_i does not fit between walls 12.8 d_i apart: at most a quarter
plasmas harris.light_over_alfven=1.2
    c (drift or thermal speed): raise harris.light_over_alfven above
plasmas species.beam.density=1
    [species.beam] belongs to plasma.setup = "uniform"; the Harris sheet makes its own
plasmas theory.wave=light -> theory.wave = "light" needs plasma.setup = "uniform"
plasmas harris.light_over_alfven=1e39 -> harris.light_over_alfven
plasmas harris.temperature_ratio=1e-39 -> harris.temperature_ratio
plasmas plasma.setup=uniform wave_E_y
    seeded fields need periodic boundaries: take out uniform.E_*, uniform.wave_E_*
plasmas beam uniform.B_x=0.1 grid.boundary_x=wall
    uniform.B_x = 0.1 would cross the conducting walls normal to x: make it 0
plasmas beam uniform.B_z=0.1 grid.boundary_z=wall
    uniform.B_z = 0.1 would cross the conducting walls normal to z: make it 0
plasmas beam uniform.mode_x=0
    uniform.mode_x and uniform.mode_z are both 0: a mode needs a wave number
implicit_moment beam uniform.mode_x=33
    the seeded mode (33, 0) has more than one wavelength per two cells: refine the mesh
implicit_moment beam uniform.mode_z=-33
    the seeded mode (1, -33) has more than one wavelength per two cells
plasmas uniform uniform.wave_B_x=1e-3
    the seeded B is not divergence-free: k . B must be 0, so keep uniform.wave_B across
plasmas uniform uniform.mode_z=1 uniform.wave_B_x=1e-3 uniform.wave_B_z=-1e-3 uniform.phase_B_z=180
    k . B must be 0, so keep uniform.wave_B across the mode; phases 180 apart turn the sign of one
    component
plasmas uniform uniform.mode_z=1 uniform.wave_E_x=1e-3 uniform.wave_E_z=-1e-3 uniform.phase_E_z=180
    seed it with the species' wave_x and wave_z; phases 180 apart turn the sign of one component
plasmas uniform uniform.wave_E_x=1e-3
    the seeded E has a part along k: that part follows from the charge, so seed it with
plasmas beam particles.relativistic=false species.beam.drift_x=0.8 species.beam.drift_z=0.8
    species 'beam' has speeds of 1.131 c (drift, seed or thermal speed): lower them
plasmas beam particles.relativistic=false species.beam.temperature_y=1.44
    species 'beam' has speeds of 1.2 c (drift, seed or thermal speed): lower them
plasmas beam particles.relativistic=false species.beam.wave_y=1
    species 'beam' has speeds of 1 c (drift, seed or thermal speed): lower them
plasmas electrons grid.cells_x=8 uniform.mode_x=4 species.electrons.wave_x=1e-4
    species.electrons.wave_x seeds a wave of two cells with its zeros where the mesh would see it:
    set species.electrons.phase_x = 90
plasmas uniform grid.cells_x=8 uniform.mode_x=4 uniform.wave_E_y=1e-4 uniform.phase_E_y=90
    set uniform.phase_E_y = 0
plasmas longitudinal species.electrons.charge=-1 grid.boundary_z=wall
    theory.wave = "longitudinal" has E along the walls across z, where conductors let none be: take
    grid.boundary_z = "periodic", or a mode along z alone
plasmas transverse species.electrons.charge=-1 grid.boundary_x=reflecting theory.component=E_y uniform.mode_z=1
    theory.wave = "transverse" has E along the walls across x
plasmas transverse species.electrons.charge=-1 grid.boundary_z=wall theory.component=E_y uniform.mode_z=1 uniform.mode_x=0 species.electrons.wave_y=1e-4
    the seed of species 'electrons' is no wave between the walls across z, where it has no nodes:
    set its phase_y = 90
implicit_moment langmuir.toml grid.cells_x=8 uniform.mode_x=4
    theory.wave = "langmuir": no wave has its E along k, since the field of this mode is smoothed
implicit_moment beam particles.relativistic=true field.rotation=mesh
    field.rotation = "mesh" turns the sums of all particles by one angle, and relativistic
implicit_moment beam particles.relativistic=true field.solver=newton_krylov
    field.solver = "newton_krylov" turns moments by one angle, and relativistic particles
implicit_moment beam particles.relativistic=true species.beam.drift_x=2 theory.wave=transverse \
    theory.component=B_z uniform.B_x=1
    species 'beam' drifts with u = 2 c: with uniform.B theory.wave = "transverse" takes drifts below
plasmas uniform uniform.E_x=1e-3 grid.boundary_x=wall
    seeded fields need periodic boundaries: take out uniform.E_*
plasmas uniform uniform.mode_z=1 uniform.wave_B_x=1e-3 uniform.wave_B_z=-5e-4 uniform.phase_B_z=9
    the two components in the plane of a wave at an angle to x and z have different phases
plasmas uniform uniform.mode_z=1 uniform.wave_B_x=1e-3 uniform.wave_B_z=1e-3 uniform.phase_B_z=-90
    the two components in the plane of a wave at an angle to x and z have different phases
plasmas cold wave_E_y -> theory.wave = "cold" needs charges: it needs a [species.<name>]
plasmas cold species.electrons.charge=-1 species.electrons.drift_y=0.1
    species 'electrons' is warm or drifts: choose "longitudinal", "transverse" or "magnetized"
plasmas cold species.electrons.charge=-1 grid.cells_x=64 grid.cells_z=64
    theory.wave = "cold" needs theory.near: without temperatures and drifts this plasma has waves at
plasmas cold species.electrons.charge=-1 theory.component=B_x theory.near=1
    no wave of the seeded mode has a part in theory.component = "B_x": choose another one
plasmas longitudinal species.electrons.charge=-1 uniform.mode_z=1 uniform.B_x=0.1
    the dispersion relation is solved for B along k or zero
plasmas magnetized species.electrons.charge=-1 uniform.mode_z=1
    theory.wave = "magnetized" needs a field: give uniform.B_x, B_y or B_z
plasmas magnetized species.electrons.charge=-1 uniform.B_x=0.1 species.electrons.temperature_y=0.1
    species 'electrons' has two temperatures across uniform.B
plasmas magnetized species.electrons.charge=-1 uniform.B_x=0.1 species.electrons.drift_y=0.1
    species 'electrons' drifts across uniform.B
plasmas magnetized species.electrons.charge=-1 uniform.B_z=1e-9 species.electrons.temperature_x=0.01 species.electrons.temperature_y=0.01
    theory.wave = "magnetized" sums over the harmonics of the gyration, and k times its radius is
plasmas magnetized species.electrons.charge=-1 uniform.B_z=0.1 grid.cells_x=64 grid.cells_z=64
    theory.wave = "magnetized" needs theory.near: without temperatures and drifts this plasma has
plasmas magnetized species.electrons.charge=-1 uniform.B_y=1 theory.near=1.03 theory.component=E_x species.electrons.temperature_x=1e-3 species.electrons.temperature_y=1e-3 species.electrons.temperature_z=1e-3
    , which has no E_x: choose E_y for theory.component, or change theory.near
implicit_moment magnetized species.electrons.charge=-1 uniform.B_x=0.1 particles.relativistic=true species.electrons.drift_x=0.3
    species 'electrons' drifts with u = 0.3 c: with uniform.B theory.wave = "magnetized" takes drifts below
plasmas transverse species.electrons.charge=-1 uniform.mode_z=1 species.electrons.temperature_z=0.1
plasmas longitudinal species.electrons.charge=-1 uniform.mode_z=1 species.electrons.temperature_z=0.1
    species 'electrons' has another temperature along x than along z, and a wave at an angle to both
    is neither longitudinal nor transverse: make them equal, or the mode along x or z
plasmas longitudinal species.electrons.charge=-1 species.electrons.drift_x=0.1
plasmas transverse species.electrons.charge=-1 species.electrons.drift_x=0.05
    is stated for a plasma without current, and along the mode it has
plasmas longitudinal species.electrons.charge=-1 species.electrons.drift_y=0.1
plasmas transverse species.electrons.charge=-1 species.electrons.drift_y=0.1
    species 'electrons' drifts across the mode with u = 0.1 c, and no other one like it the other way
plasmas longitudinal species.electrons.charge=-1 species.electrons.drift_y=0.01 uniform.B_x=0.1
    species 'electrons' drifts across uniform.B: theory.wave = "longitudinal" wants drifts along it
plasmas transverse species.electrons.charge=-1 species.electrons.temperature_y=0.01 uniform.B_x=0.1
    species 'electrons' has two temperatures across uniform.B
plasmas uniform
    an empty uniform plasma: add a [species.<name>] or seed a field with uniform.wave_E_y
implicit_moment light wave_E_y time.end=2.9
    theory.wave needs at least 10 steps to measure: raise time.end above 3
plasmas light species.electrons.charge=-1
    theory.wave = "light" is a wave in vacuum: take out the species or choose "transverse"
plasmas langmuir wave_E_y -> theory.wave = "langmuir" needs charges: it needs a [species.<name>]
plasmas transverse wave_E_y -> theory.wave = "transverse" needs a [species.<name>]
plasmas langmuir species.electrons.charge=-1 species.electrons.temperature_x=1e-4
    theory.wave = "langmuir" is exact for a cold plasma at rest, and species 'electrons' is warm or
    drifts: choose "longitudinal", "transverse" or "magnetized"
plasmas langmuir species.electrons.charge=-1 species.electrons.drift_z=0.1
    species 'electrons' is warm or drifts: choose "longitudinal"
plasmas langmuir species.electrons.charge=0 species.electrons.wave_x=1e-5 time.end=3 few
    theory.wave
plasmas langmuir species.electrons.charge=-1 uniform.B_z=0.1
    the dispersion relation is solved for B along k or zero
plasmas longitudinal species.electrons.charge=-1 uniform.B_z=0.1
    the dispersion relation is solved for B along k or zero: take out the part of uniform.B across
    the mode, or choose "magnetized" or "cold" for theory.wave
plasmas transverse species.electrons.charge=-1 uniform.B_x=0.1 uniform.mode_x=0 uniform.mode_z=1
    the dispersion relation is solved for B along k or zero
plasmas longitudinal species.electrons.charge=-1 theory.near=1e10
    no root of the longitudinal dispersion relation was found near 1e+10: change theory.near, or set
    theory.wave = "none"
implicit_moment beam uniform.particles_per_cell=1e6 grid.cells_x=4096 grid.cells_z=4096 -> memory
)");
}

TEST_CASE(
    "a step of explicit_em beyond the limits of stability is refused with the limit and the cure" *
    doctest::description("robust")) {
    check_refused(R"(
explicit_em time.dt=0.036
    time.dt = 0.036 is not below the limit of light on this mesh, 0.03536 / omega_pi (c dt < (1/dx^2
    + 1/dz^2)^(-1/2)): lower time.dt to 0.03005 or use larger cells
explicit_em grid.cells_x=1024
    time.dt = 0.03 is not below the limit of light on this mesh, 0.02236 / omega_pi
explicit_em time.dt=0.4 grid.cells_x=32 grid.cells_z=16
    omega_p dt = 2.234 is not below 2, the limit of leapfrogged plasma oscillations: lower time.dt
    to 0.2685 or use implicit_moment
explicit_em beam grid.length_x=5120 grid.length_z=2560 time.dt=2.5 species.beam.density=4
    omega_p dt = 5 is not below 2
)");
}

TEST_CASE("parameters of the sibling and wrong values are refused by explicit_em" *
          doctest::description("robust")) {
    check_refused(R"(
explicit_em plasma.setup=uniform uniform.B_z=0.1 species.beam.charge=-1
    uniform.B_z = 0.1 would cross the conducting walls normal to z: make it 0
)");
}

TEST_CASE("numbers whose products leave double precision are refused with the number" *
          doctest::description("robust")) {
    const std::string cure = " is not between 1e-40 and 1e40 in size: choose other units";
    for (const Command& command : commands(R"(
cic between_walls
    grid.length_x time.dt plasma.B_x plasma.B_y plasma.B_z boundary.potential_x_high
    output.phase_v_max species.electrons.density species.electrons.charge species.electrons.mass
    species.electrons.drift_x species.electrons.drift_y species.electrons.drift_z
    species.electrons.temperature_x species.electrons.temperature_y species.electrons.temperature_z
    species.electrons.emission species.electrons.emission_temperature
flip box
    grid.length_x grid.length_z region.gas.density region.gas.pressure region.gas.velocity_x
    region.gas.velocity_z region.gas.speed region.gas.width region.gas.energy gravity.x
    gravity.trap boundary.pressure_x_low flip.viscosity inflow.density theory.frame_x
    viscosity.linear
grains disks
    grid.length_x grid.low_x boundary.friction contact.friction load.gravity_y load.damping
    load.rise time.alpha material.default.E material.default.density
    material.default.yield_stress material.default.hardening material.default.cohesion
    material.default.tension grain.left.velocity_x grain.left.spin grain.left.amplitude
    grain.left.force grain.left.damping pack.more.shear_rate bond.joint.tension
plasmas sheet
    grid.length_x grid.length_z time.dt time.end harris.thickness harris.background
    harris.guide_field species.beam.density uniform.B_x output.fields_interval
)")) {
        for (const std::string& name : words_in(joined(command.expected)))
            for (const std::string value : {"1e+300", "1e-300", "5e-324"})
                check_refusal({command.program, command.words + " " + name + "=" + value, {}},
                              "'" + name + "' = " + value + cure);
    }
    check_refused(R"(
cic line species.electrons.charge=-1e41
    'species.electrons.charge' = -1e+41 is not between 1e-40 and 1e40 in size: choose other units
cic plane grid.length_z=1e-41
    'grid.length_z' = 1e-41 is not between 1e-40 and 1e40 in size: choose other units
grains disks grain.left.velocity_y=-1e41
    'grain.left.velocity_y' = -1e+41 is not between 1e-40 and 1e40 in size
grains disks grain.left.radius=inf -> 'grain.left.radius' must be finite, not inf
)");
}

TEST_CASE("damaged files of packs and tables of motion are refused with their line" *
          doctest::description("robust")) {
    struct Damaged {
        std::string bytes, message;
    };
    const auto check = [](const char* file, const std::string& words,
                          const std::vector<Damaged>& damaged) {
        for (const Program* program : programs_called("grains"))
            for (const auto& [bytes, message] : damaged) {
                const fs::path folder = fresh_folder(*program);
                write_all(folder / file, bytes);
                check_refusal(*program, folder, arguments_of({program, words, {}}), message);
            }
    };
    // What else is no pack: see mpm_packs.cpp.
    check("pack.txt", "mesh pack.p.kind=file pack.p.file=pack.txt",
          {{"", "[pack.p]: pack.txt: holds no grain; write lines like: disk left 0.35 0.3 0.2"},
           {"# grains\ndisk a 0.3 0.3 0.1\ndisk b 0.35 0.3 0.1\n",
            "grains 'p_a' and 'p_b' overlap by 0.15, 3 cells: move them apart"}});
    const std::string good = "# time travel\n0 0 0\n\n1 0 0.1\n";
    check("way.txt",
          "mesh grain.disk.x=0.3 grain.disk.y=0.3 material.plate.law=rigid "
          "grain.lid.material=plate grain.lid.x=0.7 grain.lid.y=0.3 grain.lid.table=way.txt",
          {{"", "[grain.lid]: way.txt: holds no travel; write two lines or more like: 0.5 1e-3"},
           {"0 0\n", "way.txt: holds no travel"},
           {"0\n1 0\n", "way.txt:1: 1 numbers for a time and a travel along x: write 2"},
           {"0 0 0 0\n", "way.txt:1: 4 numbers for a time and a travel along x: write 2"},
           {good + "2 0\n", "way.txt:5: 2 numbers for a time and a travel along x and y: write 3"},
           {"0 0\n1 0 0\n", "way.txt:2: 3 numbers for a time and a travel along x: write 2"},
           {good + "1 0 0\n",
            "way.txt:5: the time '1' is not after that of the line before: sort the lines by time"},
           {good + "0.5 0 0\n", "way.txt:5: the time '0.5' is not after"},
           {good + "2 down 0\n", "way.txt:5: 'down' is not a number: write one like 0.25 or 1e-3"},
           {good + "2 nan 0\n", "way.txt:5: 'nan' is no number to compute with: give a finite one"},
           {good + "2 1e999 0\n", "way.txt:5: '1e999' is no number to compute with"},
           {good + "1.000000000001 1 0\n",
            "steps, more than 1e9: raise time.alpha or lower time.end"},
           {good + "2 \xff 0\n", "way.txt:5: not UTF-8 text; save the file as UTF-8"},
           {good + "\x1b[2J\n", "way.txt:5: a control character"}});
}
