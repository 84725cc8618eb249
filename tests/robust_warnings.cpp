// What a dry run says of a case and warns of, and cases at the edge of what each program takes.
#include <doctest/doctest.h>

#include <string>

#include "tests/support/any_program.hpp"

using namespace facts;

TEST_CASE("what may mislead in cic is a warning with the number and the limit" *
          doctest::description("robust")) {
    check_warnings(R"(
cic line -> no warning
cic line time.dt=1
    warning: omega_p dt = 1 is above 0.5: frequencies are 4.72 % too high; at 2 the leapfrog
    blows up, and from 0.8 or so on it heats a warm plasma without end
cic line time.dt=1 plasma.B_y=0.5
    warning: omega_p dt = 1 is above 0.5: frequencies along B are 4.72 % too high
cic line wave time.end=10 species.electrons.amplitude=0.6
    warning: electrons: a cold standing wave of the amplitude 0.6, above 0.5, breaks within half a
    period, when its particles overtake each other: lower it
cic line wave time.end=10 species.electrons.amplitude=0.5 -> no warning
# Along B to the digits that are given.
cic line wave time.end=10 species.electrons.amplitude=0.01 plasma.B_x=3 plasma.B_z=1 \
    species.electrons.drift_x=0.03 species.electrons.drift_z=0.01000000001
    no warning
cic line species.electrons.density='1+cos(2*pi*x/6)' time.dt=0.4
    warning: omega_p dt = 0.5621 where the plasma is densest is above 0.5
cic line species.electrons.temperature_x=0.01
    warning: the Debye length is 0.2667 cells, below 0.3183 for cic: the mesh will heat the
    plasma; refine it to cells of 0.3142
cic line method.weighting=ngp species.electrons.temperature_x=0.01
    warning: the Debye length is 0.2667 cells, below 0.6 for ngp
cic line method.weighting=tsc species.electrons.temperature_x=0.01 -> no warning
# At the limit, to the digits that are shown.
cic thermal_heating.toml grid.length_x=201.06193 theory.compare=none -> no warning
cic line method.scheme=energy species.electrons.temperature_x=0.01 -> no warning
cic plane grid.length_z=60 species.electrons.temperature_x=0.01
    warning: the Debye length is 0.01333 cells, below 0.3183 for cic
cic plasma_wave.toml species.electrons.drift_x=1
    warning: aliases drive waves of two or three cells through cold plasma that moves, growth = 0.2
    or so: take method.scheme = "energy", or give it a temperature
cic plasma_wave.toml species.electrons.drift_x=0.2
    warning: aliases drive waves of two or three cells through cold plasma that moves, growth = 0.2
    or so: give it a temperature with a Debye length of a third of a cell or more
cic plasma_wave.toml species.electrons.drift_x=1 method.scheme=energy -> no warning
cic plasma_wave.toml species.electrons.drift_x=1 time.end=60 -> no warning
# Warm by a formula; without the scheme that is the cure; along z.
cic plasma_wave.toml species.electrons.drift_x=1 species.electrons.distribution_x='exp(-v^2/2)' \
    species.electrons.distribution_max=6 theory.model=plasma species.electrons.loading=quiet \
    -> no warning
cic plasma_wave.toml species.electrons.drift_x=1 method.weighting=ngp
    warning: aliases drive waves of two or three cells through cold plasma that moves, growth = 0.4
    or so: take method.scheme = "energy" and method.weighting = "cic", or give it
# Along B, slowly, and with ions that are warm or a little faster; not across B, nor with a beam.
cic plasma_wave.toml species.electrons.drift_x=1 plasma.B_x=1 theory.compare=none
    warning: aliases drive waves of two or three cells through cold plasma that moves
cic plasma_wave.toml species.electrons.drift_x=1 plasma.B_y=1 theory.compare=none -> no warning
cic plasma_wave.toml species.electrons.drift_x=0.03
    warning: aliases drive waves of two or three cells through cold plasma that moves
cic plasma_wave.toml species.electrons.drift_x=0.8 species.ions.motion=mobile \
    species.ions.mass=1836 species.ions.loading=lattice species.ions.drift_x=0.801
    warning: aliases drive waves of two or three cells through cold plasma that moves
cic buneman.toml -> no warning
cic cloud_collision.toml time.end=5400 -> no warning
cic line method.scheme=energy species.electrons.drift_x=0.1
    warning: electrons: a cold beam at 0.2667 omega_p dx is below 0.2887, where the
    energy-conserving mesh stops it; refine the mesh
cic line method.scheme=energy species.electrons.drift_x=0.1 species.electrons.temperature_x=0.01
    warning: electrons: the Debye length is 0.2667 cells, not above 1: in some hundred 1/omega_p
    the energy-conserving mesh brakes the drift; refine it, or take method.scheme = "momentum"
cic line method.scheme=energy species.electrons.drift_x=0.1 species.electrons.temperature_x=1
    no warning
cic line species.electrons.temperature_x=1 species.ions.motion=mobile species.ions.mass=100 \
    species.ions.temperature_x=0.01 species.ions.particles_per_cell=4
    warning: the Debye length of ions is 0.2667 cells, below 0.3183 for cic: the mesh will heat
    ions; refine it to cells of 0.3142
cic line species.electrons.drift_x=10
    warning: electrons: particles move 2.667 cells in a step; below 2 they see the field they
    cross
cic line plasma.B_y=20
    warning: electrons: Omega_c dt = 2 is above 1: gyration is slowed by the time step to 0.7854
    of its frequency; drifts stay right
cic line grid.cells_x=2063
    warning: grid.cells_x = 2063 has the prime factor 2063, above 200: its Fourier transforms
    take about 103 times as long as those of a product of 2, 3 and 5
cic plane grid.cells_z=422 -> warning: grid.cells_z = 422 has the prime factor 211, above 200
cic line output.spectrum=true output.modes=1 time.end=21.1
    warning: output.spectrum: time.end / time.dt = 211 has the prime factor 211
cic line output.fields_interval=0.01 output.particles_interval=1 output.phase_interval=0.05
    warning: output.fields_interval = 0.01 is below time.dt = 0.1: files are written every step
    warning: output.phase_interval = 0.05 is below time.dt = 0.1
cic between_walls boundary.particles_x_low=source
    warning: boundary.particles_x_low = "source", and every emission is 0: the wall only gives
    back what reaches it, with emission_temperature
# 4/9 2^1/2 V^3/2/d^2 of d = 24, in a vacuum.
cic between_walls grid.length_x=24 boundary.particles_x_low=source boundary.potential_x_high=4 \
    species.ions.charge=0 species.electrons.density=0.001 species.electrons.emission=0.01 \
    species.electrons.emission_temperature=0.01
    warning: electrons.emission = 0.01 is above the space-charge limit of Child and Langmuir,
    4/9 (2 q/m)^1/2 V^3/2/(q d^2) = 0.00873: what returns to the source is emitted again
cic between_walls grid.length_x=24 boundary.particles_x_low=source boundary.potential_x_high=4 \
    species.ions.charge=0 species.electrons.density=0.001 species.electrons.emission=0.008 \
    species.electrons.emission_temperature=0.01
    no warning
cic between_walls grid.length_x=24 boundary.particles_x_low=source boundary.potential_x_high=4 \
    species.electrons.emission=0.01 species.electrons.emission_temperature=0.01
    no warning
cic sheath.toml grid.length_x=6
    warning: grid.length_x = 6 is below 8 Debye lengths of the plasma, 16.55: the sheaths of
    both walls overlap
cic line wave species.electrons.amplitude=0.01
    warning: the wave of theory has the period 6.283, longer than time.end = 2: its frequency
    cannot be measured well
cic line wave time.end=10 species.electrons.mode_x=2
    warning: no species is perturbed in the followed mode (1, 0): only noise can start the wave
cic line time.end=0.04 -> warning: time.end = 0.04 is below half of time.dt = 0.1: no step is taken
    warning: omega_p time.end = 0.04 is below 0.1
cic line time.dt=1.7e-7 time.end=1.7e-4
    warning: omega_p time.end = 0.00017 is below 0.1: particles fly straight on
cic line species.electrons.temperature_x=1 grid.length_x=4e-4 time.dt=1e-5
    warning: the box has 0.0004 Debye lengths, below 1: particles cross it before their
    field can act
cic line time.dt=1.7e-7 time.end=1.7e-4 plasma.B_y=1e4 -> no warning
cic line time.dt=1.7e-7 time.end=1.7e-4 grid.boundary_x=wall \
    boundary.potential_x_high=1
    no warning
cic line time.end=0 -> no warning
cic line grid.boundary_x=wall boundary.particles_x_low=reflect boundary.particles_x_high=reflect \
    time.end=100
    warning: a cold plasma that touches walls does not rest in the momentum scheme: the field on
    the nodes of a wall drives it, and noise grows as exp(
cic line grid.boundary_x=wall boundary.particles_x_low=reflect boundary.particles_x_high=reflect \
    time.end=100 method.scheme=energy
    no warning
cic line grid.boundary_x=wall boundary.particles_x_low=reflect boundary.particles_x_high=reflect \
    time.end=100 species.electrons.temperature_x=4
    no warning
cic plane plasma.B_y=0.7 time.end=200
    warning: B_y turns forces of the momentum scheme, which on a mesh are not along k, into growth
cic plane plasma.B_y=0.7 time.end=200 method.scheme=energy -> no warning
cic plane plasma.B_z=0.7 time.end=200 -> no warning
cic plane plasma.B_z=0.7 plasma.B_x=0.7 time.end=200
    warning: B oblique to the mesh turns forces of the momentum scheme, which on a mesh are not
    along k, into growth
)");
}

TEST_CASE("what may mislead in a fluid is a warning with the number and the limit" *
          doctest::description("robust")) {
    check_warnings(R"(
flip tube
fluids sod -> no warning
fluids sod particles.seed=2
    warning: particles.seed changes nothing: particles of loading = "lattice" have no random
    places, and no region has noise
fluids sod particles.seed=2 particles.loading=random -> no warning
pic tube -> warning: the flow has Mach 0, below 0.05: cells feel a particle only when it enters them
flip tube region.gas.velocity_x=0.12
    warning: region.gas flows over the mesh at Mach 0.1014, between 0.07 and 0.19, where
    explicit FLIP rings
flip around region.gas.velocity_z=-0.12
    warning: region.gas flows over the mesh at Mach 0.1014, between 0.07 and 0.19
flip around region.gas.velocity_x=0.12 flip.density=particles -> no warning
flip taylor_green.toml flip.density=cells
    warning: region.gas flows at Mach 0.09996, below 0.19, where explicit FLIP with flip.density =
    "cells" rings and slow flow gains energy: set flip.density = "particles"
flip taylor_green.toml flip.density=cells flip.pressure=implicit -> no warning
flip taylor_green.toml particles.per_cell_x=2 particles.per_cell_z=2
    warning: with 2 particles across a cell, below 3, the flow of region.gas draws voids between them
flip taylor_green.toml particles.per_cell_x=3 particles.per_cell_z=3 -> no warning
flip taylor_green.toml flip.confined=true flip.viscosity=0 time.end=2
    warning: flip.confined with explicit pressure fills the room that particles leave
flip taylor_green.toml flip.confined=true flip.pressure=implicit -> no warning
flip tube boundary.x_low=inflow boundary.x_high=open boundary.pressure_x_high=1 inflow.density=1 \
    inflow.pressure=1 inflow.velocity_x=0.05 region.gas.velocity_x=0.05
    warning: region.gas flows at Mach 0.04226, below 0.19, where explicit FLIP with flip.density =
    "cells" rings behind an inflow
flip tube viscosity.linear=0 flip.transfer=apic time.end=20
    warning: explicit steps of apic make the shortest sound waves grow where viscosity.linear = 0
flip tube viscosity.linear=0 flip.transfer=apic time.end=0.1 -> no warning
flip tube viscosity.linear=0 time.end=20 -> no warning
flip sod viscosity.linear=0 viscosity.quadratic=0
    warning: without artificial viscosity particles pile up at shocks
pic sod viscosity.linear=0 viscosity.quadratic=0
    warning: without artificial viscosity the method has none where the fluid rests
flip tube flip.pressure=implicit region.gas.velocity_x=1
    warning: the flow has Mach 0.8452, above 0.5, and time.cfl with implicit pressure
flip tube flip.pressure=implicit region.gas.velocity_x=1 time.dt=0.005 -> no warning
flip tube flip.pressure=implicit region.gas.velocity_x=1 time.dt=0.009
    warning: the flow has Mach 0.8452, above 0.5, and sound crosses 1.065 cells in time.dt, above 1
flip acoustic.toml flip.pressure=explicit flip.theta=1 flip.tolerance=1e-8 time.dt=0 \
    region.gas.velocity_x=0.7 theory.frame_x=0.7 flip.mass=consistent
    no warning
flip acoustic.toml grid.cells_x=6 -> warning: the mesh slows this wave by
flip acoustic.toml flip.transfer=pic -> no warning
flip acoustic.toml flip.transfer=blend flip.blend=0 flip.pressure=explicit flip.theta=1 \
    flip.tolerance=1e-8 time.dt=0
    no warning
flip gravity_wave.toml flip.density=cells
    warning: flip.density = "cells" counts the particles of region.water, a liquid beside gas, and
    steps of implicit pressure make flow of what is miscounted
flip dam_break.toml flip.density=cells
    warning: flip.density = "cells" counts the particles of region.column, a liquid beside a void,
    and steps of implicit pressure
flip dam_break.toml flip.density=cells flip.pressure=explicit flip.theta=1 flip.tolerance=1e-8
    warning: without artificial viscosity particles pile up at shocks
    warning: flip.density = "cells" counts the particles of region.column, a liquid beside a void,
    and its weight makes flow of what is miscounted
flip dam_break.toml -> no warning
flip sphere_hits_plate.toml -> no warning
pic sod right.density=1 grid.cells_x=200 time.end=0.25
    warning: the left fluid flows over the mesh at Mach 0.4867 behind its wave, below 0.6, where
    classical PIC rings, and sound crosses
flip sod right.density=1 grid.cells_x=200 time.end=0.25 -> no warning
pic sod right.density=1 grid.cells_x=40 time.end=0.25 -> no warning
flip acoustic.toml grid.cells_x=16 -> no warning
pic acoustic.toml flip.density=cells flip.pressure=explicit flip.theta=1 flip.tolerance=1e-8 \
    time.dt=0 region.gas.amplitude=0.1 grid.cells_x=8
    warning: the mesh slows this wave by 9.968 %, and the comparison expects that: a wavelength has
    8 cells
    warning: explicit steps make sound grow
flip kelvin_helmholtz.toml flip.viscosity=0.001
    warning: flip.viscosity = 0.001 changes this wave by up to about 1.261 %, and theory is of fluids
    without it
flip rayleigh_taylor.toml flip.viscosity=1e-6 -> no warning
flip rayleigh_taylor.toml grid.cells_x=32 grid.cells_z=64 region.upper.density=1.2
    warning: on this mesh the wave grows at 0.9356 of the rate of the fluids, beyond
    theory.tolerance = 0.05: refine the mesh
flip around sound region.gas.mode=4 viscosity.linear=0 time.end=10
    warning: explicit steps make sound grow, this wave by a factor
flip around sound viscosity.linear=0 time.end=10 particles.per_cell_x=5 time.cfl=0.01
    warning: with 5 particles across a cell, an odd number, the wave of region.gas stirs the lattice
flip around sound theory.compare=wave time.end=1
    warning: viscosity.linear = 0.5 damps the wave, and theory is of sound that nothing damps
flip tube boundary.x_low=no_slip
    warning: a no_slip wall holds fluid without viscosity only through the mesh
flip tube particles.per_cell_x=2 particles.per_cell_z=1
    warning: 2 particles per cell are fewer than 4: a particle that leaves a cell takes 50 % of
    its density along
flip around flip.mass=consistent particles.per_cell_x=2
    warning: flip.mass = "consistent" with 2 particles across a cell, below 3
flip around flip.mass=consistent particles.per_cell_x=3 viscosity.linear=0 time.end=10
    warning: with 3 particles across a cell and viscosity.linear = 0 weak flow grows by up to
flip around flip.mass=consistent viscosity.linear=0 time.end=10 -> no warning
flip around flip.mass=consistent particles.per_cell_x=3 viscosity.linear=0.2 time.end=10
    no warning
flip around particles.per_cell_z=3 viscosity.linear=0 time.end=10
    warning: with 3 particles across a cell and viscosity.linear = 0 weak flow grows by up to
flip around particles.per_cell_x=3 viscosity.linear=0 time.end=10 flip.density=particles
    no warning
flip around viscosity.linear=0 time.end=10 -> no warning
flip around viscosity.linear=0 time.end=100 flip.transfer=xpic -> no warning
flip around viscosity.linear=0 time.end=100 flip.density=particles
    warning: with 4 particles across a cell and viscosity.linear = 0 weak flow grows by up to
flip around flip.mass=consistent viscosity.linear=0 time.end=100
    warning: with 4 particles across a cell and viscosity.linear = 0 weak flow grows by up to
flip around viscosity.linear=0 time.end=100
    warning: with 4 particles across a cell and viscosity.linear = 0 weak flow grows by up to
flip box rings gas particles.per_cell_x=3 viscosity.linear=0 time.end=10
    warning: with 3 particles across a cell and viscosity.linear = 0 weak flow grows by up to
flip pond.toml flip.pressure=implicit flip.transfer=apic time.end=120
    warning: particles that gather within a cell fall, no pressure feels it, and the transfer of apic
    lets it grow by about exp(26.83) until time.end: set flip.transfer = "xpic"
flip pond.toml flip.pressure=implicit flip.transfer=xpic time.end=300 -> no warning
flip pond.toml flip.pressure=implicit flip.transfer=apic time.end=60 -> no warning
# A free surface, and steps that make its waves grow; not where the fluid is at rest before that.
flip box water dam theory.compare=none implicit flip.density=particles flip.theta=0.6 flip.transfer=xpic \
    time.end=12
    warning: steps of
flip box water dam theory.compare=none implicit flip.density=particles flip.theta=0.6 flip.transfer=xpic \
    time.end=3
    no warning
flip box water dam theory.compare=none implicit flip.density=particles flip.transfer=xpic time.end=12
    no warning
flip box water dam theory.compare=none implicit flip.density=particles flip.theta=0.6 flip.transfer=xpic \
    time.end=12 time.dt=0.005
    no warning
flip dam_break.toml -> no warning
flip box no_slip flip.viscosity=0.1 flip.transfer=xpic
    warning: beside a no_slip wall flip.transfer = "xpic" brakes a viscous flow
flip box no_slip flip.viscosity=0.1 -> no warning
pic rings around region.gas.angular_velocity=0.5 boundary.x_low=slip boundary.x_high=slip
    warning: the flow has Mach 0 beside its swirl, below 0.05
flip tube rezone.steps=5 rezone.max_particles=12
    warning: rezone.max_particles = 12 is below the 16 particles per cell of the start
flip tube region.drop.shape=disk region.drop.radius=1e-6
    warning: region.drop contains no particle
flip tube material.a.gamma=1.4 material.b.gamma=1.4 -> warning: material.b is nowhere
flip tube output.fields_interval=1e-6 output.particles_interval=1
    warning: output.fields_interval = 1e-06 is below the first time step, 0.002535: files are
    written every step
flip sod theory.compare=riemann left.velocity=-0.3
    warning: boundary.x_low = "slip", where the gas moves with -0.3, sends a wave into the mesh that
    the exact solution does not know: take "open"
flip sod theory.compare=riemann boundary.x_low=open left.velocity=0.3
    warning: boundary.x_low = "open", where the gas moves with 0.3, sends a wave into the mesh that
    the exact solution does not know: take "inflow"
flip sod theory.compare=riemann boundary.x_low=open
    warning: boundary.pressure_x_low = 0, where the gas has 1, sends a wave into the mesh that the
    exact solution does not know: take that
fluids free_expansion.toml -> no warning
flip toro_4.toml -> no warning
pic toro_4.toml -> no warning
fluids toro_4.toml right.gamma=1.6667 inflow.x_high.material=left
    warning: inflow.x_high brings material.left, gamma = 1.4 and p_infinity = 0, and region.right at
    that end is material.right, gamma = 1.667 and p_infinity = 0: set inflow.x_high.material =
    "right", where that is not meant
fluids toro_4.toml inflow.x_low.material=right
    warning: inflow.x_low brings material.right, gamma = 1.4 and p_infinity = 0, and region.left at
fluids toro_4.toml inflow.x_low.pressure=400
    warning: inflow.x_low with density 5.999, pressure 400, velocity 19.6, where the gas has
    density 5.999, pressure 460.9, velocity 19.6, sends a wave into the mesh that the exact solution
    does not know: take that
flip box gas material.air.gamma=1.4 material.water.gamma=4.4 material.water.p_infinity=600 \
    region.gas.material=air boundary.z_high=inflow inflow.velocity_z=-1 inflow.material=water
    warning: inflow.z_high brings material.water, gamma = 4.4 and p_infinity = 600, and region.gas at
    that end is material.air, gamma = 1.4 and p_infinity = 0
flip box gas material.air.gamma=1.4 material.smoke.gamma=1.4 region.gas.material=air \
    boundary.z_high=inflow inflow.velocity_z=-1 inflow.material=smoke
    no warning
flip sod theory.compare=riemann time.end=0.4
    warning: at time.end the waves are at x = 0.02671 and 1.201, beyond the ends
fluids sod theory.compare=riemann left.velocity=-2 left.pressure=0.4 right.density=1 \
    right.pressure=0.4 right.velocity=2 boundary.x_low=open boundary.x_high=open time.end=0.15
    warning: between the waves a cell will have
fluids around region.gas.velocity_x=1 time.end=1e-6
    warning: until time.end = 1e-06 sound or the flow crosses 8.555e-05 cells, below 0.1: the run is
    over before anything happens; raise time.end
flip around region.gas.velocity_x=1 time.end=1e-6 implicit
    warning: until time.end = 1e-06 sound or the flow crosses 6.986e-05 cells, below 0.1
    warning: the flow has Mach
flip around region.gas.velocity_x=1 time.end=1e-6 region.gas.pressure=1e10
    no warning
flip around theory.compare=wave sound
    warning: the wave has the period 0.8452, longer than time.end = 0.1
    warning: viscosity.linear = 0.5 damps the wave
pic around sound
    warning: the flow has Mach 0.01002, below 0.05
    warning: the wave of region.gas takes 0.2037 particles across a border of cells, below 2: cells
    do not feel that density changes, and sound has another speed; take flip, or
    particles.per_cell_x = 64
pic around sound region.gas.amplitude=1e-3
    warning: the flow has Mach 0.0009999, below 0.05
    warning: the wave of region.gas takes 0.02037 particles across a border of cells, below 2: cells
    do not feel that density changes, and sound has another speed; take flip, or
    particles.per_cell_x = 64 with region.gas.amplitude = 0.006136
# Stiff bodies in a void.
pic sphere_hits_plate.toml -> no warning
pic sphere_hits_plate.toml region.ball.velocity_z=-0.2
    warning: the flow has Mach 0.4348, and particles that come and go make pressures in stiff bodies
    that add about 0.3968 of the kinetic energy of the start: take flip
pic sphere_hits_plate.toml region.ball.velocity_z=-0.2 particles.per_cell_x=8 particles.per_cell_z=8
    no warning
flip sphere_hits_plate.toml region.ball.velocity_z=-0.2 -> no warning
pic tube region.gas.velocity_x=0.5 flip.transfer=apic
    warning: flip.transfer = "apic" means nothing to pic, whose particles are mass alone
pic tube region.gas.velocity_x=0.5 flip.mass=consistent
    warning: flip.mass = "consistent" means nothing to pic, whose particles are mass alone
pic tube region.gas.velocity_x=0.5 flip.deficit_to_heat=false
    warning: flip.deficit_to_heat = false means nothing to pic, whose particles are mass alone
pic tube region.gas.velocity_x=0.5 flip.density=particles
    warning: flip.density = "particles" means nothing to pic, whose particles are mass alone
pic tube region.gas.velocity_x=0.5 rezone.steps=5
    warning: rezone.steps = 5 means nothing to pic, whose particles are mass alone
)");
}

TEST_CASE("what may mislead in grains is a warning with the number and the limit" *
          doctest::description("robust")) {
    check_warnings(R"(
mpm_explicit disks -> no warning
grains disks time.end=1e-3
    warning: until time.end = 0.001 sound crosses 0.07538 cells, below 0.1: the run is over before
    anything happens; raise time.end
mpm_implicit disks time.end=2e-3 time.alpha=0.1 -> no warning
mpm_implicit disks time.end=2e-3 -> no warning
grains disks time.dt=3e-3
    warning: time.end = 0.1 is no whole number of steps of time.dt = 0.003: the run ends at t = 0.099
mpm_explicit disks time.alpha=0.8
    warning: time.alpha = 0.8 is above 0.7: nothing bounds the energy of explicit solutions, and
    grains that meet will burst
mpm_explicit disks time.alpha=0.8 method.frozen=true -> no warning
mpm_explicit rebound.toml material.default.viscosity=0.03 -> no warning
mpm_explicit rebound.toml material.default.viscosity=0.05
    warning: viscosity makes the steps 14.38 times shorter, more than 10: mpm_implicit needs no
    shorter ones
mpm_implicit rebound.toml material.default.viscosity=0.05 -> no warning
mpm_explicit disks grain.left.velocity_x=0.3669
    warning: grains meet with 0.06363 c_p (each of two with half of their closing speed), above
    0.05: an impact strains the grains by more than the small strains of the material laws
mpm_explicit disks grain.left.velocity_x=18
    warning: grains meet with 2.467 c_p (each of two with half of their closing speed), above 0.05:
    an impact strains the grains by more than the small strains of the material laws, and faster than sound a grain passes into what it hits
mpm_explicit mesh end left grain.left.velocity_x=0.3669 -> no warning
# What moves together, and a grain that meets a wall.
grains rebound.toml grain.left.velocity_x=1.1 grain.right.velocity_x=0.9 boundary.x_high=open theory.compare=none -> no warning
mpm_explicit mesh end left grain.left.velocity_x=0.3669 boundary.x_high=frictional
    warning: grains meet with 0.1 c_p
mpm_explicit disks load.gravity_y=-2.25
    warning: g H/c_p^2 = 0.1003 is above 0.05: grains at the bottom are crushed by the weight of
    a full mesh; stiffen the material
grains incline_block.toml theory.compare=none grain.plate.x=0.25 grain.plate.width=0.5 grain.right.shape=box \
    grain.right.x=1.25 grain.right.y=0.075 grain.right.width=1.5 grain.right.height=0.15 grain.right.material=plate
    warning: rigid grains 'plate' and 'right' abut at x = 0.5: what slides over the seam is stopped
    or slowed by their ends; make one grain of them
# Two plates that make a groove.
grains incline_block.toml theory.compare=none grain.block.y=0.44 grain.block.height=0.1 grain.plate.angle=-20 \
    grain.plate.x=0.27 grain.plate.y=0.17 grain.plate.width=0.5 grain.right.shape=box grain.right.angle=20 \
    grain.right.x=0.7913 grain.right.y=0.17 grain.right.width=0.5 grain.right.height=0.15 grain.right.material=plate
    no warning
grains incline_block.toml contact.friction=0.7
    warning: friction of 0.7, above 0.65: a block that it holds near the angle of friction flutters
    without viscosity and may slide; set material.<name>.viscosity = 0.00327
grains incline_block.toml contact.friction=0.7 material.default.viscosity=0.003 -> no warning
grains rolling_cylinder.toml grid.cells_x=240 grid.cells_y=48 contact.friction=0.1
    warning: a disk on a rigid surface with friction of 0.1: where it slips friction gives it too
    little spin, by a part of 0.01 over the coefficient where it is stiff, and up to 0.05 where
    weight flattens it
grains rolling_cylinder.toml grid.cells_x=240 grid.cells_y=48 theory.compare=none grain.plate.angle=2 \
    grain.plate.width=1.9 grain.plate.y=0.1 grain.plate.height=0.05 grain.cylinder.y=0.25
    warning: a disk beside rigid grain 'plate', with sides at an angle to the mesh: nodes hold it
    off its lowest point, and where it slips friction gives it too little spin, by a part of up to
    0.07 (mpm_implicit 0.1) over the coefficient; put the sides along the mesh and turn gravity
grains incline_block.toml theory.compare=none grain.block.shape=polygon grain.block.sides=8
    warning: a polygon has a side of 1.531 cells, below 6, beside an obtuse corner: nodes know its
    ends to half a cell, and standing on it, it topples at a slope that may be 65.33 per cent off;
    refine the mesh
grains incline_block.toml boundary.y_low=slip
    warning: boundary.y_low = "slip" holds for good what comes near, a cell too early, and a grain
    begins 3 cells from it: take "frictional", with boundary.friction = 0 where it is smooth
# A name that no grain has, as one that is misspelt.
grains rebound.toml material.defualt.viscosity=0.1
    warning: [material.defualt] is new; the case has [material.default]
    warning: material.defualt is nowhere: no grain is of it
grains rebound.toml material.soft.E=1e3 pair.p.b=soft pair.p.friction=0.1
    warning: material.soft is nowhere: no grain is of it
    warning: pair.p is nowhere: no grain is of material 'soft'
grains rebound.toml theory.compare=none material.soft.E=1e4 grain.left.material=soft pair.p.a=soft pair.p.friction=0.1
    no warning
mpm_explicit disks contact.separation=0
    warning: contact.separation = 0: grains meet where they share nodes, up to 1.5 cells too
    early
mpm_explicit disks grid.particles_per_side=1 -> no warning
mpm_explicit disks output.particles_interval=1e-3 output.fringes_interval=1 \
    output.grains_interval=1e-4
    warning: output.particles_interval = 0.001 is below the time step 0.003226: files are
    written every step
    warning: output.grains_interval = 0.0001 is below the time step 0.003226
mpm_explicit plates grain.bottom.force=2
    warning: grain 'bottom' has a force and control = "velocity": the force does nothing
mpm_explicit plates grain.top.velocity_y=-0.1
mpm_explicit plates grain.top.swing_y=-0.01
    warning: grain 'top' has control = "force_y" and a velocity or a swing in that direction: it does
    nothing, the grain starts at rest
mpm_explicit plates grain.top.velocity_x=-0.1 -> no warning
grains rolling_cylinder.toml
    warning: a disk has a radius of 4 cells, below 12: where it rolls on a rigid surface it loses
    speed to vibration, at U^2 = g R over eight radii 5 to 22 per cent with 4 cells and 4 to 10
    with 8 (in mpm_explicit, least with method.transfer = "spin"), in mpm_implicit 1 to 6; a slow one loses a larger
    part
grains rolling_cylinder.toml grid.cells_x=220 grid.cells_y=44
    warning: a disk has a radius of 11 cells, below 12
grains rolling_cylinder.toml grid.cells_x=240 grid.cells_y=48 -> no warning
grains rolling_cylinder.toml contact.friction=0 -> no warning
mpm_implicit billet.toml theory.compare=none method.shape=gimp grain.billet.y=0.318 grain.bottom.y=0.068 \
    grain.top.y=0.568 grid.cells_y=14
    warning: rigid grain 'bottom' is 2 cells thick, below 2.5: off the lines of nodes
    warning: rigid grain 'top' is 2 cells thick, below 2.5
mpm_implicit billet.toml theory.compare=none method.shape=gimp -> no warning
# Where the outline of a block cuts particles beside a plate.
mpm_explicit plate_holds.toml theory.compare=none method.shape=gimp grid.cells_y=16 grain.block.y=0.365 \
    grain.bottom.y=0.09 grain.bottom.height=0.15 grain.top.y=0.64 grain.top.height=0.15
    warning: the outline of 'block' cuts particles beside plate 'bottom': with method.shape = "gimp" the
    layer there bears up to 0.06 more or less than the others (one particle per side: more); take "linear",
    mpm_implicit, or sides of the block at multiples of 0.025 from the corner of the mesh
mpm_explicit plate_holds.toml theory.compare=none method.shape=gimp grid.cells_y=16 grain.block.y=0.375 \
    grain.bottom.y=0.1 grain.bottom.height=0.15 grain.top.y=0.65 grain.top.height=0.15 -> no warning
mpm_implicit billet.toml theory.compare=none method.shape=gimp grid.cells_y=16 grain.billet.y=0.365 \
    grain.bottom.y=0.09 grain.bottom.height=0.15 grain.top.y=0.64 grain.top.height=0.15 -> no warning
mpm_implicit billet.toml theory.compare=none time.alpha=1 time.end=4 method.theta=0.5 grain.top.velocity_y=-0.01
    warning: method.theta = 0.5 damps nothing that rings, and in what is pressed noise may grow by a
    warning: grains are strained by 0.1, above 0.05
mpm_implicit billet.toml theory.compare=none time.alpha=1 time.end=4 method.theta=0.6 method.shape=gimp grain.top.velocity_y=-0.01 -> no warning
grains bonded_bar.toml theory.compare=none grain.left.profile=none material.steel.law=rigid grain.left.material=steel method.shape=quadratic
    warning: method.shape = "quadratic" sees a rigid grain that is bonded to another one from three
grains bonded_bar.toml theory.compare=none grain.left.profile=none material.steel.law=rigid grain.left.material=steel method.shape=gimp
    warning: method.shape = "gimp" sees a rigid grain that is bonded to another one from a cell
grains bonded_bar.toml theory.compare=none method.shape=quadratic -> no warning
mpm_explicit plate_holds.toml method.shape=quadratic
    warning: method.shape = "quadratic" makes flat grains that a rigid one presses too soft
mpm_explicit plate_holds.toml theory.compare=none time.end=10 grain.top.stop=0 grain.top.velocity_y=-0.01
    warning: grains are pressed by 0.2375, above 0.1: particles of linear shapes that cross lines
mpm_explicit plate_holds.toml theory.compare=none time.end=10 grain.top.stop=0 grain.top.velocity_y=-0.01 method.shape=gimp -> no warning
mpm_explicit plate_holds.toml theory.compare=none time.end=5 grain.top.stop=0 grain.top.velocity_y=0.01 bond.all.tension=1e9
    warning: grains are stretched by 0.1125, above 0.05: motion of particles that nodes do not see
mpm_explicit plate_holds.toml theory.compare=none time.end=5 grain.top.stop=0 grain.top.velocity_y=0.01 -> no warning
mpm_implicit billet.toml theory.compare=none time.alpha=1 time.end=10 method.theta=1 grain.top.velocity_y=-0.01 method.shape=linear
    warning: grains are strained by
    warning: method.volumes = "kept", and grains are strained by
# Damping and viscosity that are too small to end it.
mpm_implicit billet.toml theory.compare=none time.alpha=1 time.end=4 method.theta=0.5 method.shape=gimp grain.top.velocity_y=-0.01 load.damping=1e-9 material.default.viscosity=1e-12
    warning: method.theta = 0.5 damps nothing that rings, and in what is pressed noise may grow by a
mpm_implicit billet.toml theory.compare=none time.alpha=1 time.end=4 method.theta=0.5 method.shape=gimp grain.top.velocity_y=-0.01 load.damping=100
    no warning
mpm_implicit rebound.toml -> no warning
mpm_implicit rebound.toml time.alpha=15 time.end=6 -> no warning
mpm_implicit rebound.toml grid.periodic_x=true grain.left.velocity_x=1.1 grain.right.velocity_x=0.9 -> no warning
mpm_implicit rebound.toml time.alpha=25 time.end=10 output.particles_interval=0
    warning: |v| dt/h = 0.6557 is above 0.5: grains can pass through each other's surfaces
    before they are seen to touch; reduce time.alpha
mpm_implicit vibrating_bar.toml time.alpha=60 time.end=2000 output.particles_interval=0
    no warning
# A collision on a fine mesh: of one density, and of two, where the lighter disk moves farther.
mpm_implicit rebound.toml grid.cells_x=96 grid.cells_y=48
    warning: grains that meet move 0.8722 cells while sound crosses one, above 0.6: particles that
    cross lines of nodes leave a part of a rebound as vibration, up to a tenth at 0.7 and a fifth at
    1.4, and on finer meshes more; set method.shape = "gimp"
mpm_implicit rebound.toml grid.cells_x=96 grid.cells_y=48 method.shape=gimp -> no warning
mpm_implicit rebound.toml theory.compare=none material.heavy.E=1e4 material.heavy.nu=0.3 material.heavy.density=4000 \
    grain.right.material=heavy grain.left.velocity_x=0.16 grain.right.velocity_x=-0.04
    warning: grains that meet move 0.6977 cells while sound crosses one, above 0.6
mpm_implicit rebound.toml grid.cells_x=144 grid.cells_y=72 method.shape=gimp
    warning: grains that meet move 1.308 cells while sound crosses one, above 1.2: particles that
    cross lines of nodes leave a part of a rebound as vibration, up to a tenth at 1.4, and on finer
    meshes more; set method.theta = 0.55
mpm_implicit rebound.toml grid.cells_x=144 grid.cells_y=72 method.shape=gimp method.theta=0.55 -> no warning
mpm_explicit rebound.toml grid.cells_x=144 grid.cells_y=72 -> no warning
mpm_explicit rebound.toml grid.cells_x=192 grid.cells_y=96
    warning: grains that meet move 1.744 cells while sound crosses one, above 1.35
mpm_explicit rebound.toml grid.cells_x=192 grid.cells_y=96 method.shape=gimp -> no warning
mpm_implicit rebound.toml theory.compare=none method.shape=gimp grain.left.shape=polygon grain.left.vertices='0.1 0.2, 0.5 0.2, 0.5 0.3'
    warning: in the corner of 14.04 degrees of grain 'left', below 20, particles are fewer than nodes,
    and the consistent mass matrix may be nearly singular: take grid.particles_per_side = 3, or blunt
mpm_implicit rebound.toml theory.compare=none method.shape=gimp grain.left.shape=polygon grain.left.vertices='0.1 0.2, 0.5 0.2, 0.5 0.3' \
    grid.particles_per_side=3
    no warning
mpm_implicit rebound.toml theory.compare=none method.shape=gimp grain.left.shape=polygon grain.left.vertices='0.1 0.2, 0.5 0.2, 0.5 0.3' \
    method.mass=lumped
    no warning
mpm_implicit rebound.toml method.flip=0.9
    warning: method.flip = 0.9 is below 1: [MPM-13] is for FLIP, and the column pic takes the
    rest
mpm_implicit rebound.toml grid.particles_per_side=1
    warning: grid.particles_per_side = 1 with the consistent mass matrix, which is then nearly
    singular: take 2, or method.mass = "lumped"
mpm_implicit rebound.toml grid.particles_per_side=1 method.mass=lumped
    no warning
)");
}

TEST_CASE("what may mislead is a warning with the number and the limit" *
          doctest::description("robust")) {
    // In implicit_moment, v_e = (25/6 B0^2/2)^(1/2) = 0.0722 and dz = 0.2. The default of
    // explicit_em resolves 0.29 of a cell per Debye length: v_e/omega_pe = 0.0722/5 = 0.01443 d_i;
    // and Omega_ce dt = 25 * 1.0 * 0.03.
    check_warnings(R"(
implicit_moment -> no warning
implicit_moment time.dt=3
    warning: electrons: v_th dt (1/dx^2 + 1/dz^2)^1/2 = 1.21 is above 0.9, where the moment closure
    fails [IMM-13]: lower time.dt to 2.231 or take fewer cells
implicit_moment time.dt=30
    warning: ions: v_th dt (1/dx^2 + 1/dz^2)^1/2 = 5.413 is above 0.9, where the moment closure
    fails [IMM-13]: lower time.dt to 4.988 or take fewer cells
    warning: electrons: v_th dt (1/dx^2 + 1/dz^2)^1/2 = 12.1 is above 0.9
    warning: electrons: Omega_c dt = 37.5 is above 2 pi, gyration is not followed
implicit_moment few
    warning: electrons: v_th dt/dx = 0.006766 is below 0.05 and the Debye length is 0.004511
    cells: finite-grid heating is possible, watch the energy
    warning: the sheet has 0.3125 cells across its whole thickness, below 2
explicit_em -> no warning
plasmas time.dt=1e-9 time.end=1e-6
    warning: omega_p time.end = 5.099e-06 and Omega_c time.end = 1.25e-06 are below 0.1: fields have
    no time to act; raise time.end, which is in units of 1/omega_pi
plasmas electrons species.electrons.temperature_x=0.01 grid.length_x=0.001 grid.length_z=0.001 \
    time.dt=1e-6 time.end=1
    warning: the box has 0.01 Debye lengths, below 1: particles cross it before their field can act
plasmas electrons time.dt=1e-4 time.end=0.01
    warning: omega_p time.end = 0.01 and Omega_c time.end = 0 are below 0.1
plasmas electrons time.dt=1e-4 time.end=0.01 grid.length_x=0.1 wave_E_y -> no warning
plasmas electrons grid.boundary_z=wall uniform.mode_x=0 uniform.mode_z=1 species.electrons.wave_z=1e-4
    warning: the seed of species 'electrons' moves particles through the walls across z and is no
    wave between them: set its phase_z = 90
    warning: the species together have a charge of -1 e n0, and between walls nothing makes it
    neutral: add a species of the other charge
plasmas electrons grid.boundary_z=wall uniform.mode_x=0 uniform.mode_z=1 species.electrons.wave_z=1e-4 species.electrons.phase_z=90
    warning: the species together have a charge of -1 e n0
plasmas electrons species.electrons.charge=0
    warning: no species has a charge, and no field acts on any: give one a charge
plasmas uniform uniform.E_x=1e-3 uniform.B_y=1
    warning: there is no species for fields to act on: add a [species.<name>]
# The drift of a wave across k that runs along walls is no motion through them.
explicit_em transverse grid.boundary_z=wall theory.component=E_z time.dt=0.02 theory.near=1 \
    species.electrons.charge=-1 species.electrons.wave_z=1e-4 species.ions.mass=100 -> no warning
explicit_em grid.cells_x=256 grid.cells_z=128
    warning: electrons: the Debye length is 0.1443 cells, below 0.2: where the plasma drifts the
    mesh may heat it, watch the energy
explicit_em time.dt=0.3 grid.cells_x=48 grid.cells_z=24
    warning: omega_p dt = 1.676 is above 1.62, where oscillations of a warm plasma may grow:
    lower time.dt to 0.2685
    warning: ions: the Debye length is
    warning: electrons: the Debye length
explicit_em harris.light_over_alfven=10 harris.guide_field=10
    warning: electrons: Omega_c dt = 0.7537 is above 0.5, gyration is too slow by more than 2 %:
    lower time.dt to 0.0199
    warning: drift and heat of gamma v make v smaller, so that the current is about 2.768 % too
    small to balance the field and the sheet is no exact equilibrium: set particles.relativistic =
    false, or raise harris.light_over_alfven
explicit_em harris.light_over_alfven=10 harris.guide_field=0 particles.relativistic=false time.dt=0.01
    no warning
explicit_em relativistic_two_stream.toml field.smoothing_passes=4 -> no warning
explicit_em relativistic_two_stream.toml
    warning: species 'right' drifts along x with 0.8944 c, and the shortest waves of light on this mesh with
    0.6697 c: it may feed them (numerical Cherenkov radiation); set field.smoothing_passes = 4
    warning: species 'left' drifts along x with 0.8944 c
explicit_em uniform time.dt=0.1 grid.cells_x=64 grid.cells_z=32 species.e.charge=-1 species.p.charge=1 \
    species.e.drift_x=0.05 species.p.drift_x=0.05 species.e.temperature_x=1e-3
    warning: the Debye length is 0 cells, below 0.6, and the plasma drifts as a whole: the mesh may
    brake it, watch the momentum, or set particles.order = 2 and field.smoothing_passes = 4
explicit_em uniform time.dt=0.1 grid.cells_x=64 grid.cells_z=32 species.e.charge=-1 species.p.charge=1 \
    species.e.drift_y=0.05 species.p.drift_y=0.05 -> no warning
explicit_em e_cross_b.toml uniform.E_x=0.1
    warning: the drift c E/B would be 0.2 c, above 0.05, and its theory has no Lorentz factor: lower
explicit_em beam particles.relativistic=false species.beam.temperature_x=0.09 grid.cells_x=512
    warning: beam: about 7198 of 8.389e+06 particles, 0.08581 %, are loaded faster than light, and
    the push is not relativistic
explicit_em beam species.beam.temperature_x=0.09 grid.cells_x=512
    warning: beam: about 7198 of 8.389e+06 particles, 0.08581 %, are loaded with u = gamma v above c
implicit_moment e_cross_b.toml uniform.E_x=0.3 uniform.B_y=0.2
    warning: uniform.E across B is 1.5 of B, and the drift E x B would be that many times as fast
# What another set-up reads.
plasmas uniform.B_x=0.1 current_sheet.drift=2
    warning: [current_sheet] has no effect with plasma.setup = "harris": take out what is there
    warning: [uniform] has no effect with plasma.setup = "harris": take out what is there
plasmas beam harris.guide_field=1
    warning: [harris] has no effect with plasma.setup = "uniform": take out what is there
implicit_moment harris.particles=20000 grid.length_z=60
    warning: the sheet has 1.067 cells across its whole thickness, below 2, and is not resolved:
    raise grid.cells_z, or lower grid.length_z
implicit_moment lhdi_quick.toml grid.cells_z=8
    warning: the sheet has 1.778 cells across its whole thickness, below 2, and is not resolved:
    raise grid.cells_z, or lower current_sheet.length_z
implicit_moment lembege_pellat.toml grid.length_x=57 grid.cells_z=32
    warning: ions: v_th dt/dx = 0.02421 is below 0.05 and the Debye length is 0.02581 cells
    warning: the sheet has 1.599 cells across its whole thickness at its thin end, below 2, and is
    not resolved: raise grid.cells_z, or lower grid.length_z or harris.normal_field
implicit_moment beam species.beam.temperature_y=0.09
    warning: beam: about 225 of 2.621e+05 particles
)");
}

TEST_CASE("a dry run shows scales and theory and memory and time" *
          doctest::description("robust")) {
    // In rebound, c_p^2 = 1.346 E/density, dt = 0.25 h/(c_p + |v|), and 0.4^2 pi/4 (2/h)^2
    // particles are in each disk. In the hot disk of a fluid, c^2 = gamma (gamma - 1) E/m =
    // 0.56/(524/16384).
    check_descriptions(R"(
cic two_stream.toml --threads 2 --out run
    mesh +128 cells of 0\.08016, periodic in x
    method +cic weighting, momentum-conserving
    steps +1600 of 0\.05
    particles +65536
    all mobile species together +omega_p = 1, omega_p dt = 0\.05, cold
    right +32768 particles, omega_p = 0\.7071, v_th = 0, speed of the drift = 1
    theory +mode \(1, 0\): omega = 0, growth = 0\.3536 omega_p; .*
    onset +about t = .*
    memory +about [0-9.e+]+ [KMG]iB.*
    time +about [0-9.e+-]+ .*
cic diocotron.toml -> .*128 x 128 cells of 0\.125 x 0\.125, periodic in x, walls in z.*
cic misprint.toml -> .*div E = -rho as the slide prints it.*
flip sod theory.compare=riemann boundary.x_high=open
    mesh                100 x 1 cells of 0\.01 x 1, slip and open in x, periodic in z
    method              flip transfer, lumped mass, density of cells, explicit pressure
    left                about 800 particles, sound speed 1\.183, speed up to 0
    right               about 800 particles, sound speed 1\.058, speed up to 0
    particles           about 1600
    steps               about 40; the first of 0\.0025.*
    theory              pressure 0\.3031 and velocity 0\.9275 at the contact
    memory              about .*
    time                about .*
flip sod flip.viscosity=0.1 -> .*steps               about 3200; the first of 3\.125e-05.*
pic tube theory.compare=wall_shock region.gas.velocity_x=-1 time.dt=1e-3
    .*velocity and energy on the cells
    steps               100 of 0\.001
    .*density 2\..*
flip box region.hot.shape=disk region.hot.radius=0.1 region.hot.center_x=0.5 \
    region.hot.center_z=0.5 region.hot.energy=1 region.hot.pressure=0
    .*particles, sound speed 4\.18.*
mpm_explicit rebound.toml --threads 2 --out run
    mesh +48 x 24 cells of 0\.025
    walls +x: open, open; y: .*
    method +linear shape functions, FLIP
    grains +2, the thinnest 16 cells
    particles +about 1608, 2 x 2 per cell
    sound +c_p = 3\.669, largest \|v\| = 0\.1
    steps +1207 of dt = 0\.001657, alpha = 0\.25
    memory +about [0-9.e+-]+ MiB
    time +about [0-9.e+-]+ s on.*
mpm_explicit shear.toml -> .*50 x 46 cells of 0\.02, periodic in x.*
mpm_explicit disks method.shape=gimp method.flip=0.9 method.frozen=true boundary.y_low=stick
    .*gimp shape functions, FLIP fraction 0\.9, frozen particles
    .*y: stick, open
mpm_implicit rebound.toml --threads 2
    mesh +48 x 24 cells of 0\.025
    method +linear shape functions, FLIP, theta = 0\.5, consistent mass
    particles +about 1608, 2 x 2 per cell
    sound +c_p = 3\.669, largest \|v\| = 0\.1
    steps +302 of dt = 0\.006623, alpha = 1
    memory +about [0-9.e+-]+ MiB
    time +about [0-9.e+-]+ s on.*
implicit_moment --threads 2 --out run
    mesh +64 x 64 cells of 0\.4 x 0\.2 d_i, periodic in x, wall in z
    steps +2667 of 0\.3 / omega_pi, c dt/dx = 0\.75, c dt/dz = 1\.5
    particles +200000, 48\.83 per cell
    magnetic field +0\.05 m_i c omega_pi/e, Omega_ci dt = 0\.015
    ions +omega_p dt = 0\.3, Omega_c dt = 0\.015, v_th = 0\.03227 c, .*
    electrons +omega_p dt = 1\.5, Omega_c dt = 0\.375, v_th = 0\.07217 c, .*
    memory +about [0-9.e+]+ [KMG]iB.*
    time +about [0-9.e+-]+ .*
)");
}

TEST_CASE("a case at the edge of what is taken is described without a number that is none" *
          doctest::description("robust")) {
    check_descriptions(R"(
fluids tube time.end=0
fluids tube grid.cells_x=2
fluids box grid.cells_x=2 grid.cells_z=300
fluids tube particles.per_cell_x=1 particles.per_cell_z=1
fluids tube dust
fluids tube dust region.gas.pressure=0
fluids box region.gas.pressure=0
fluids box grid.cells_x=8192 grid.cells_z=8192
fluids box boundary.x_low=inflow inflow.velocity_x=1 disk region.gas.radius=1e-9
fluids box water region.gas.pressure=0
fluids sod left.velocity=-20 right.velocity=20 theory.compare=riemann
fluids tube material.a.gamma=1.4 material.b.gamma=1.4 material.c.gamma=1.4 \
    material.d.gamma=1.4 material.e.gamma=1.4 material.f.gamma=1.4 material.g.gamma=1.4 \
    material.h.gamma=1.4
flip tube grid.length_x=1e-20 grid.length_z=1e-20 time.end=1e-21
flip walls_z tube
flip box flip.transfer=flip
flip box flip.transfer=pic
flip box flip.transfer=blend
flip box flip.transfer=apic
flip box flip.transfer=xpic
# Bonds across the seam of a periodic mesh, within a quarter of a cell; the other disk yields.
mpm_explicit disks periodic grain.left.x=0.2 grain.right.x=0.99 joint
mpm_explicit disks theory.compare=yield material.soft.law=j2 grain.right.material=soft \
    theory.grain=right
# Hardening that elastic grains ignore.
mpm_implicit billet.toml material.default.hardening=1
mpm_implicit rebound.toml material.default.law=j2 newton
mpm_implicit rebound.toml method.volumes=updated newton
    mesh .*
    method .*
    particles .*
    steps .*
    memory .*
)");
}

TEST_CASE("a case at the edge of what cic takes ends with status 0" *
          doctest::description("robust")) {
    // Like charges attract, and particles cross so many boxes in a step that round-off loses them;
    // the last of the electrons is absorbed before new ones come; in a corner a particle meets the
    // source and another wall in the same step.
    check_accepted(R"(
cic line time.end=0 output.fields_interval=1
cic line time.end=1e-30
cic line time.end=0.1
cic line output.fields_interval=1e30 output.particles_interval=1e30
cic line grid.cells_x=2 species.electrons.particles_per_cell=1
cic line species.electrons.amplitude=-0.9 species.electrons.mode_x=-8
cic line no_charge time.dt=1e20 time.end=1e21
cic line grid.length_x=1e-20
cic line wave gauss.sign=-1 species.electrons.temperature_x=4 species.electrons.amplitude=0.01
cic line gauss.sign=-1 time.energy_limit=0 time.dt=1e10 time.end=1e12 \
    species.electrons.amplitude=0.1
cic between_walls boundary.x_low=floating boundary.x_high=floating
cic between_walls grid.cells_x=2 boundary.potential_x_high=100 boundary.x_low=floating
cic plane grid.boundary_x=wall boundary.particles_x_low=source boundary.potential_x_low=-1e6 \
    species.electrons.emission=0.5 plasma.B_y=0.1
cic plane box boundary.particles_x_low=source time.dt=0.4 time.end=20 \
    species.electrons.emission=1 species.electrons.temperature_x=30 \
    species.electrons.temperature_z=30
cic plane points_at_ends
cic plane points_at_ends box
)");
    for (const std::string weighting : {"ngp", "cic", "tsc"})
        for (const std::string scheme : {"momentum", "energy"})
            for (const std::string ends :
                 {"", " grid.boundary_x=wall", " grid.boundary_z=wall", " box"}) {
                if (weighting == "ngp" && scheme == "energy") continue;
                check_accepted(
                    "cic plane grid.cells_x=3 grid.cells_z=3 method.stencil=nine_point "
                    "time.end=10 species.electrons.temperature_x=1 "
                    "species.electrons.temperature_z=1 method.weighting=" +
                    weighting + " method.scheme=" + scheme + ends);
            }
}

TEST_CASE("a case at the edge of what the grains take ends with status 0" *
          doctest::description("robust")) {
    check_accepted(R"(
mpm_explicit disks time.end=0 output.fringes_interval=1 output.grains_interval=1
mpm_explicit disks time.end=1e-30 output.pack=true
mpm_explicit disks time.alpha=1e30
mpm_explicit disks output.particles_interval=1e30 output.grains_interval=1e30
mpm_explicit disks grid.particles_per_side=16 time.end=0.01
mpm_explicit disks grid.low_x=-1000 grain.left.x=-999.65 grain.right.x=-999.15
mpm_explicit disks grain.left.velocity_x=0 grain.right.velocity_x=0 output.vtk=true \
    output.particles_interval=0.05
# A ring around the shortest periodic mesh, and grains that straddle its ends.
mpm_explicit body periodic grain.body.velocity_x=0.3 grain.body.height=0.3
mpm_explicit body periodic grain.body.x=0.7 grain.body.width=0.6 grain.body.height=0.3 \
    method.shape=quadratic
mpm_explicit disks periodic grain.left.x=1.25 grain.right.x=-0.45
mpm_explicit plates grain.top.force=-1e-3 grain.top.damping=1e30
mpm_explicit plates grain.bottom.velocity_x=0.1 load.rise=1e30
mpm_explicit mesh end pack.p.kind=file pack.p.file='"a pack'"'"'s file.txt"'
mpm_explicit mesh end one_disk pack.p.columns=3 pack.p.sides=5
)");
    for (const std::string solver : {"", " newton"}) {
        for (const std::string arguments :
             {"time.end=0", "time.alpha=1e30 time.end=2", "grid.particles_per_side=1",
              "grid.particles_per_side=8 method.shape=quadratic",
              "grain.left.velocity_x=0 grain.right.velocity_x=0"})
            check_accepted("mpm_implicit disks " + arguments + solver);
    }
    // The smallest mesh, full, with every kind of wall.
    for (const std::string shape : {"linear", "gimp", "quadratic"})
        for (const std::string wall : {"slip", "stick", "rub"})
            for (const std::string program :
                 {"mpm_explicit small ", "mpm_implicit small ", "mpm_implicit small newton "})
                check_accepted(program + wall + " method.shape=" + shape);
}

TEST_CASE("a plasma without any energy runs or is refused" * doctest::description("robust")) {
    for (const Command& command : commands("plasmas beam few species.ions.charge=1 time.end=3")) {
        const fs::path folder = fresh_folder(*command.program);
        const Outcome outcome =
            start(*command.program, folder, arguments_of(command) + " --out run");
        INFO(command.program->name << ": " << outcome.err);
        CHECK((outcome.status == 0 || outcome.status == 2));
        CHECK(fs::exists(folder / "run") == (outcome.status == 0));
    }
}
