# The front door. `make` alone prints the menu; products go to build/ and out/ and nowhere else.

VERSION := 1.0.0

# Numbers are read and written with a decimal point, whatever language the user speaks.
export LC_ALL := C.UTF-8

# ---- what there is (the figures are further down, one line each) --------------------------------

# The source of each main; a program is called like its main.
mains := cic/cic.cpp flip/pic/pic.cpp flip/flip/flip.cpp mpm_explicit/mpm_explicit.cpp mpm_implicit/mpm_implicit.cpp implicit_moment/implicit_moment.cpp implicit_moment/explicit_em/explicit_em.cpp

# Programs that time the loop of a main, step by step; `make bench` runs them all.
benches := cic/bench.cpp flip/bench.cpp mpm_explicit/bench.cpp mpm_implicit/bench.cpp implicit_moment/bench.cpp \
           implicit_moment/explicit_em/bench.cpp

# ---- how: everything here can be set on the command line, e.g. make CXX=clang++-14 test ---------

ifeq ($(origin CXX),default)
CXX := g++
endif
EIGEN    ?= /usr/include/eigen3
ARCH     ?= -march=native
OPTIMIZE ?= $(if $(SANITIZE),-O1 -g,-O3)
SANITIZE ?=
TRAP     ?=
REAL     ?= double
MPI      ?=
JOBS     ?= 2
ARGS     ?=
CLANG_FORMAT ?= clang-format

# Other kinds of build have a folder of their own.
BUILD   := build$(if $(SANITIZE),/sanitize)$(if $(TRAP),/trap)$(if $(filter float,$(REAL)),/float)$(if $(MPI),/mpi)
objects := $(BUILD)/objects

warnings := -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wno-psabi
sanitize := $(if $(SANITIZE),-fsanitize=$(SANITIZE) -fno-sanitize-recover=all -fno-omit-frame-pointer)

# Wide vectors where the machine has them; there, g++ 12 takes intrinsics that Eigen uses for
# uninitialized. clang says of some loops that it leaves them as they are, which is no defect, and does not know
# [[gnu::noclone]]. The compiler is asked when it is first used, not when make starts: `make deps` may
# have installed it in between.
machine = $(eval machine := $(shell $(CXX) $(ARCH) -dM -E -x c++ /dev/null 2>/dev/null | awk '\
    /__AVX512F__/ { wide = 1 } /__clang__/ { clang = 1 } \
    END { if (wide) print "-mprefer-vector-width=512"; if (wide && !clang) print "-Wno-maybe-uninitialized"; if (clang) print "-Wno-pass-failed -Wno-unknown-attributes" }'))$(machine)

# Nobody asks errno of a square root, or which operation was not exact; without both, loops with square
# roots, floor() and choices vectorize (with g++; clang's default is the same).
flags   = -std=c++20 $(OPTIMIZE) $(ARCH) -fopenmp -fno-math-errno $(if $(TRAP),,-fno-trapping-math) $(sanitize) $(warnings) $(machine) $(CXXFLAGS)
defines = -DEIGEN_DONT_PARALLELIZE -DREAL=$(REAL) -DRANKS=$(if $(MPI),true,false) -DPROGRAM_VERSION=\"$(VERSION)\" -DBUILD_FOLDER=\"$(BUILD)\"
include_paths = -I. -isystem $(EIGEN) $(CPPFLAGS)
libraries = -lgsl -lgslcblas -lm $(LDLIBS)
# HDF5 files where the library is; without it everything else is the same.
hdf5 = $(firstword $(wildcard /usr/include/hdf5/serial/hdf5.h /usr/include/hdf5.h))
openpmd = $(if $(hdf5),$(BUILD)/openpmd.so)

# With MPI its own compiler, which calls ours, compiles what calls it and links; and these programs have ranks.
mpi_cxx = env OMPI_CXX='$(CXX)' MPICH_CXX='$(CXX)' mpicxx
ifneq ($(MPI),)
mains := cic/cic.cpp implicit_moment/implicit_moment.cpp implicit_moment/explicit_em/explicit_em.cpp
endif
# In single precision those whose step computes in it.
ifneq ($(filter float,$(REAL)),)
mains   := cic/cic.cpp implicit_moment/explicit_em/explicit_em.cpp
benches := cic/bench.cpp implicit_moment/explicit_em/bench.cpp
endif

# With `make deps fig09`, also with -j, everything waits until the packages are there.
packages_first := $(filter deps deps-dev deps-sweep deps-mpi deps-web,$(MAKECMDGOALS))

# $(call need,command): stop with a cure where a tool is missing.
need = @command -v $(1) >/dev/null || { echo "'$(1)' is not installed: run 'make deps'" >&2; exit 2; }

programs  := $(basename $(notdir $(mains)))
bench_programs := $(benches:%.cpp=$(BUILD)/benches/%)
tests     := $(basename $(notdir $(wildcard tests/*.cpp)))
shared    := $(patsubst %.cpp,$(objects)/%.o,$(filter-out %/formula.cpp %/openpmd.cpp %/ranks.cpp,$(wildcard common/*.cpp common/*/*.cpp)) $(if $(TRAP),tests/support/trap_invalid.cpp) $(if $(MPI),common/ranks.cpp))
# What the theory of a method compiles by itself. From an archive the linker takes what a program calls: only who
# reads formulas needs muParser.
theory_of  = $(patsubst %.cpp,$(objects)/%.o,$(wildcard $(1)/theory/*.cpp))
theory    := $(BUILD)/theory.a
formula   := $(BUILD)/formula.a
sources   := $(wildcard */*.hpp */*/*.hpp */*/*/*.hpp */*.cpp */*/*.cpp lecture_notes/page/*/*/*/*.hpp)
folder_of  = $(patsubst %/,%,$(dir $(filter %/$(1).cpp,$(mains))))
method_of  = $(firstword $(subst /, ,$(call folder_of,$(1))))

MAKEFLAGS += --no-builtin-rules
# Compilers work side by side. Runs do not: each takes all cores for its threads.
ifeq ($(filter clean,$(MAKECMDGOALS)),)
MAKEFLAGS += -j$(JOBS)
endif
one_at_a_time = $(if $(shell command -v flock),flock out)
.SUFFIXES:
.DELETE_ON_ERROR:
.SECONDEXPANSION:
.PRECIOUS: $(objects)/%.o $(objects)/fuzz/%.o out/%/.complete
.PHONY: menu deps deps-dev deps-sweep deps-mpi plot watch movie movies compare sweep all install dist figures cost explicit_gem test tests test-long exercise exercises torture mutate fuzzers bench \
        notes format clean FORCE $(programs)

# ---- the menu ------------------------------------------------------------------------------------

define menu_text
The particle-in-cell family in running code

  make deps              install the packages that are missing (apt-get); elsewhere: say which
  make implicit_moment   build one program: $(programs)
  make all               build every program
  make fig09             run what is stale and draw into out/figures/: $(sort $(filter fig%,$(figures)))
                         $(filter-out fig% cic_% mpm_% pic_% flip_%,$(figures))
                         $(wordlist 1,4,$(cic_figures))
                         $(wordlist 5,9,$(cic_figures))
                         $(wordlist 10,99,$(cic_figures))
                         $(wordlist 1,4,$(fluid_figures))
                         $(wordlist 5,8,$(fluid_figures))
                         $(wordlist 9,12,$(fluid_figures))
                         $(wordlist 13,99,$(fluid_figures))
                         $(wordlist 1,3,$(mpm_figures))
                         $(wordlist 4,6,$(mpm_figures))
                         $(wordlist 7,9,$(mpm_figures))
                         $(wordlist 10,12,$(mpm_figures))
                         $(wordlist 13,15,$(mpm_figures))
                         $(wordlist 16,99,$(mpm_figures))
  make figures           draw them all
  make plot RUN=out/cic/mine     every figure that fits a run; also: make watch RUN=... while it runs,
                         make movie RUN=..., make compare A=... B=... of two runs
  make movies            the talk's figures that move: $(movies)
  make sweep CASE=cic/cases/thermal_heating.toml KEYS='method.weighting=ngp,cic,tsc seed=1,2,3'
                         all combinations side by side (make deps-sweep), a table and a figure
  make cost              the cost slide, measured: explicit over implicit, against the mass ratio
  make explicit_gem      the full explicit run of that slide, to the plateau, forty minutes; resumable
  make test              the facts, some 18 minutes on two cores, half of it compiling   (make test ARGS='-R gmres': some)
  make test-long         every figure at full length, its numbers checked
  make torture           half an hour of kills, failing disks, forged files and fuzzing; resumable
  make mutate            the changes in a program that no fact notices: PROGRAM=cic N=50 SEED=1; resumable
  make exercises         the exercises of the lecture notes, each with its title and the time of its runs
  make exercise E=1-3    its question, its runs, and whether they give what is expected
                         (with ANSWER=0.5: is the answer right?)
  make bench             particle-steps per second on 1 and 2 threads, and where the time goes; MPI=1: on 1 and 2 ranks
  make web               the programs in the browser, a page per case, in out/web/ (packages: make deps-web);
                         CASES='two_stream': one of them
  make test-web          every page run in Chromium, beside the native programs; CASES='gem': some of them
  make notes             refresh the code and the numbers in the lecture notes
  make book              the notes as out/book/index.html and out/book.pdf   (packages: make deps-book)
  make validation        what the finished runs say beside theory: out/book/validation.html
  make format            clang-format all sources   (packages, also for torture: make deps-dev)
  make install           programs and cases to PREFIX=/usr/local   (also DESTDIR=)
  make dist              the sources as an archive, build/particle-in-cell-$(VERSION).tar.gz
  make clean             remove build/ and out/, with all programs, runs and figures

  make SANITIZE=address,undefined test     the facts under the sanitizers, in build/sanitize/
  make TRAP=1 test                         the facts, ended where 0/0 or inf - inf arises, in build/trap/
  make MPI=1 all         programs that share a case among machines, in build/mpi/ (packages: make deps-mpi):
                         mpirun -n 4 build/mpi/explicit_em; implicit_moment, cic
  make REAL=float bench                    particles of cic and explicit_em in single precision, in build/float/
  make CXX=clang++-14 all                  another compiler; also ARCH=, OPTIMIZE=, EIGEN=, CXXFLAGS=
  make OPTIMIZE=-O0 BUILD=build/quick cic  compiled in less than half the time
endef
export menu_text

menu:
	@printf '%s\n' "$$menu_text"

# ---- packages ------------------------------------------------------------------------------------

deps:
	@CXX='$(CXX)' EIGEN='$(EIGEN)' sh common/packages.sh

# One after the other, in this order: apt-get wants its lists and its archives for itself.
deps-dev: | $(filter deps,$(MAKECMDGOALS))
	@sh common/packages.sh clang-format locales clang libclang-rt-dev libomp-dev llvm strace libhdf5-dev hdf5-tools

deps-sweep: | $(filter deps deps-dev,$(MAKECMDGOALS))
	@sh common/packages.sh parallel ffmpeg

deps-mpi: | $(filter deps deps-dev deps-sweep,$(MAKECMDGOALS))
	@sh common/packages.sh libopenmpi-dev openmpi-bin

# ---- programs ------------------------------------------------------------------------------------

all: $(programs) $$(openpmd)
tests: $(tests:%=$(BUILD)/tests/%)
$(programs): %: $(BUILD)/% $$(openpmd)

# The flags and a fingerprint of compiler and machine: when they change, everything is built again.
$(BUILD)/flags: FORCE | $(packages_first)
	$(call need,$(firstword $(CXX)))
	@mkdir -p $(@D)
	@new=$@.$$$$; { echo '$(CXX) $(flags) $(include_paths) $(libraries)'; \
	   $(CXX) $(flags) $(defines) -dM -E -x c++ /dev/null | cksum; } > $$new; \
	   cmp -s $$new $@ || cp $$new $@; rm -f $$new

$(objects)/%.o: %.cpp $(BUILD)/flags
	@mkdir -p $(@D)
	$(CXX) $(flags) $(defines) $(include_paths) -MMD -MP -c -o $@ $<

$(objects)/common/ranks.o: common/ranks.cpp $(BUILD)/flags
	@command -v mpicxx >/dev/null || { echo "'mpicxx' is not installed: run 'make deps-mpi'" >&2; exit 2; }
	@mkdir -p $(@D)
	$(mpi_cxx) $(flags) $(defines) -DOMPI_SKIP_MPICXX -DMPICH_SKIP_MPICXX $(include_paths) -MMD -MP -c -o $@ $<

# Facts take half as long to compile at -O1, and most of them no longer to run: what takes long are programs and theory.
long_at_O1 := cic_theory_mesh cic_theory_waves implicit_moment_drift_theory implicit_moment_mass_matrix
ifeq ($(SANITIZE),)
# There g++ takes vectors whose lanes are written one by one, ours and Eigen's, for uninitialized.
$(patsubst %,$(objects)/tests/%.o,$(filter-out $(long_at_O1),$(tests))): \
    private OPTIMIZE = -O1 $(if $(findstring -Wno-unknown-attributes,$(machine)),,-Wno-uninitialized -Wno-maybe-uninitialized)
endif

# The reader of case files must refuse bad input with a message, never with an assertion of its library.
$(objects)/common/run/case_file.o: private defines += -DNDEBUG

$(BUILD)/openpmd.so: common/run/openpmd.cpp $(wildcard common/run/*.hpp) $(BUILD)/flags
	$(CXX) $(flags) $(defines) $(include_paths) -isystem $(dir $(hdf5)) -fPIC -shared -o $@ $< -l$(if $(findstring serial,$(hdf5)),hdf5_serial,hdf5)

$(theory): $(foreach method,cic flip mpm_explicit mpm_implicit implicit_moment,$(call theory_of,$(method)))
$(formula): $(objects)/common/run/formula.o
$(theory) $(formula):
	@rm -f $@
	$(AR) rcs $@ $^

# What a summary says of the program: its flags, and the revision of the sources when it was linked.
$(objects)/common/run/summary.o: private defines += -DBUILD_FLAGS='"$(CXX) $(flags)"'
name_revision = @printf 'extern const char* const source_revision;\nconst char* const source_revision = "%s";\n' \
    "$$(git describe --always --dirty 2>/dev/null)" | $(CXX) $(flags) -x c++ -c -o $(objects)/$(@F).revision.o -
define link
@mkdir -p $(@D)
$(if $(MPI),$(mpi_cxx),$(CXX)) $(flags) -o $@ $(filter %.o %.a,$^) $(libraries) -Wl,--as-needed -lmuparser -lfftw3 -lfftw3f
endef
# The largest object first, so that the others are compiled beside it.
$(programs:%=$(BUILD)/%): $(BUILD)/%: $$(objects)/$$(call folder_of,$$*)/$$*.o $$(call theory_of,$$(call method_of,$$*)) $(shared) $(formula) $(BUILD)/flags
	$(name_revision)
	$(link) $(objects)/$(@F).revision.o
$(tests:%=$(BUILD)/tests/%): $(BUILD)/tests/%: $(objects)/tests/%.o $(objects)/tests/support/doctest_main.o $(shared) $(theory) $(formula) $(BUILD)/flags
	$(link)
$(bench_programs): $(BUILD)/benches/%: $(objects)/%.o $(shared) $(theory) $(formula) $(BUILD)/flags
	$(link)

-include $(patsubst %.cpp,$(objects)/%.d,$(mains) $(benches) $(wildcard */theory/*.cpp common/*.cpp common/run/*.cpp tests/*.cpp))

# ---- runs and figures ----------------------------------------------------------------------------

# A run is fresh when it ended with status 0 after the last change of its program and its case, and
# nobody has started another run in its folder since: every start writes a new case.toml.
define runs_of_program
out/$(1)/%/.complete: $(2)/cases/%.toml $(BUILD)/$(1) $$$$(wildcard out/$(1)/$$$$*/case.toml) | $(packages_first)
	@rm -f $$@
	@mkdir -p $$(@D)
	$$(one_at_a_time) $(BUILD)/$(1) $$< --out $$(@D) --resume
	@touch $$@
endef
$(foreach p,$(programs),$(eval $(call runs_of_program,$p,$(call method_of,$p))))

# $(call figure,name,method folder,folder of the run): after the run, the picture.
define figure
.PHONY: $(1)
figures += $(1)
$(1): out/figures/$(1).png
	@echo "figure: out/figures/$(1).png"
out/figures/$(1).png: $(2)/figures/$(1).gp $(3)/.complete $(wildcard common/*.gp common/*.awk common/snapshots.sh $(2)/*/*.csv) | $(packages_first)
	$$(call need,gnuplot)
	@mkdir -p $$(@D)
	gnuplot -e "run='$(3)'; out='$$@'" $$<
	@test -s $$@
endef

# $(call series,script,program,cases,folder): several runs, by  sh SCRIPT PROGRAM FOLDER .
define series
$(4)/.complete: $(1) $(BUILD)/$(2) $(3) | $(packages_first)
	@rm -f $$@
	@mkdir -p $$(@D)
	$$(one_at_a_time) sh $(1) $(BUILD)/$(2) $$(@D)
	@touch $$@
endef

$(eval $(call figure,fig08,implicit_moment,out/implicit_moment/gem))
$(eval $(call figure,fig09,implicit_moment,out/implicit_moment/gem))
$(eval $(call figure,fig10,implicit_moment,out/implicit_moment/gem))

$(eval $(call figure,implicit_moment_dispersion,implicit_moment,out/implicit_moment/dispersion))
$(eval $(call series,implicit_moment/figures/implicit_moment_dispersion.sh,implicit_moment,$(wildcard \
    implicit_moment/cases/light_wave.toml implicit_moment/cases/langmuir.toml),out/implicit_moment/dispersion))

# The thin current sheets, ten runs of which data/ keeps what their figures need: `make fig14` draws it, `make fig14 RERUN=1` runs them again first, side
# by side, which takes two hours on two cores and goes on where it was stopped.
sheets := implicit_moment/data/thin_sheet_runs.csv
define figure_of_sheets
.PHONY: $(1)
figures += $(1)
$(1): out/figures/$(1).png
	@echo "figure: out/figures/$(1).png"
out/figures/$(1).png: implicit_moment/figures/$(1).gp $(sheets) $(wildcard implicit_moment/data/thin_sheet_* common/style.gp) | $(packages_first)
	$$(call need,gnuplot)
	@mkdir -p $$(@D)
	gnuplot -e "out='$$@'" $$<
	@test -s $$@
endef
$(foreach f,fig11 fig13 fig14 fig15,$(eval $(call figure_of_sheets,$f)))
$(eval $(call series,implicit_moment/figures/thin_sheets.sh,implicit_moment,implicit_moment/cases/kink.toml,out/implicit_moment/thin_sheets))
ifneq ($(RERUN),)
$(sheets): out/implicit_moment/thin_sheets/.complete implicit_moment/data/keep_thin_sheets.sh
	sh implicit_moment/data/keep_thin_sheets.sh out/implicit_moment/thin_sheets implicit_moment/data
endif

# The cost slide: both programs, by  sh SCRIPT IMPLICIT EXPLICIT FOLDER .
$(eval $(call figure,fig_cost,implicit_moment,out/implicit_moment/cost))
out/implicit_moment/cost/.complete: implicit_moment/figures/fig_cost.sh $(BUILD)/implicit_moment $(BUILD)/explicit_em \
    implicit_moment/cases/gem.toml implicit_moment/cases/gem_explicit.toml implicit_moment/data/explicit_gem_flux.csv | $(packages_first)
	@rm -f $@
	@mkdir -p $(@D)
	$(one_at_a_time) sh $< $(BUILD)/implicit_moment $(BUILD)/explicit_em $(@D)
	@touch $@
cost: fig_cost
	@sh implicit_moment/figures/show_cost.sh out/implicit_moment/cost/cost.dat

# The full explicit run of the cost slide, carried to t Omega_ci = 40 as the implicit one, forty minutes on two idle cores, and what is kept of it for figures. It goes on where it was stopped.
explicit_gem: $(BUILD)/explicit_em
	@mkdir -p out/explicit_em/gem_explicit
	$(one_at_a_time) $(BUILD)/explicit_em implicit_moment/cases/gem_explicit.toml time.end=800 \
	    --out out/explicit_em/gem_explicit --resume
	sh implicit_moment/data/keep_explicit_gem.sh out/explicit_em/gem_explicit implicit_moment/data

# The energy theorem: both programs, by  sh SCRIPT IMPLICIT EXPLICIT FOLDER .
$(eval $(call figure,implicit_moment_energy,implicit_moment,out/implicit_moment/energy))
out/implicit_moment/energy/.complete: implicit_moment/figures/implicit_moment_energy.sh $(BUILD)/implicit_moment $(BUILD)/explicit_em \
    implicit_moment/cases/finite_grid.toml | $(packages_first)
	@rm -f $@
	@mkdir -p $(@D)
	$(one_at_a_time) sh $< $(BUILD)/implicit_moment $(BUILD)/explicit_em $(@D)
	@touch $@

# What ranks are worth, from pieces that were measured: nothing runs.
$(eval $(call figure,implicit_moment_ranks,implicit_moment,out/implicit_moment/ranks))
out/implicit_moment/ranks/.complete: implicit_moment/figures/implicit_moment_ranks.sh implicit_moment/data/ranks_pieces.csv \
    implicit_moment/data/explicit_gem_strips.csv
	@rm -f $@
	@mkdir -p $(@D)
	sh $< $(@D)
	@touch $@

$(eval $(call figure,implicit_moment_mass_ratio,implicit_moment,out/implicit_moment/mass_ratios))
$(eval $(call series,implicit_moment/figures/implicit_moment_mass_ratio.sh,implicit_moment,$(wildcard \
    implicit_moment/cases/gem.toml implicit_moment/cases/gem_1836.toml),out/implicit_moment/mass_ratios))

$(eval $(call figure,implicit_moment_magnetotail,implicit_moment,out/implicit_moment/guide_fields))
$(eval $(call series,implicit_moment/figures/implicit_moment_magnetotail.sh,implicit_moment,$(wildcard \
    implicit_moment/cases/magnetotail.toml),out/implicit_moment/guide_fields))

$(eval $(call figure,implicit_moment_tail,implicit_moment,out/implicit_moment/tails))
$(eval $(call series,implicit_moment/figures/implicit_moment_tail.sh,implicit_moment,$(wildcard \
    implicit_moment/cases/lembege_pellat.toml implicit_moment/cases/thin_tail.toml),out/implicit_moment/tails))

# The lower-hybrid drift instability; _quick is the same in a minute, with fewer particles and the same script.
define drift_instability
$(call figure,fig12$(1),implicit_moment,out/implicit_moment/lhdi$(1))
out/figures/fig12$(1).png: implicit_moment/figures/keep_modes.awk
endef
$(eval $(call drift_instability,))
$(eval $(call drift_instability,_quick))
out/figures/fig12_quick.png: implicit_moment/figures/fig12.gp

# $(call cic_series,figure,cases,folder): a figure of several runs of cic.
define cic_series
$(call figure,$(1),cic,$(3))
$(call series,cic/figures/$(1).sh,cic,$(2:%=cic/cases/%.toml),$(3))
endef
$(foreach c,two_stream warm_two_stream two_stream_2d weak_beam buneman bump_on_tail sheath diocotron ion_acoustic,\
    $(eval $(call figure,cic_$c,cic,out/cic/$c)))
$(eval $(call cic_series,cic_plasma_wave,plasma_wave landau,out/cic/waves_on_the_mesh))
$(eval $(call cic_series,cic_landau,landau,out/cic/landau_damping))
$(eval $(call cic_series,cic_upper_hybrid,upper_hybrid,out/cic/magnetic_fields))
$(eval $(call cic_series,cic_bernstein,bernstein,out/cic/bernstein_modes))
$(eval $(call cic_series,cic_misprint,misprint,out/cic/both_signs))
$(eval $(call cic_series,cic_cloud_collision,cloud_collision,out/cic/clouds))
$(eval $(call cic_series,cic_grid_instability,cold_beam_grid_instability,out/cic/cold_beams))
$(eval $(call cic_series,cic_thermal_heating,thermal_heating,out/cic/heating))
# Scripts that they share.
$(patsubst %,out/figures/%.png,$(filter cic_%,$(figures))): $(filter-out cic/figures/cic_%,$(wildcard cic/figures/*))

cic_figures = $(filter cic_%,$(figures))

# $(call fluid_series,figure,cases,folder): a figure of several runs, by  sh SCRIPT PIC FLIP FOLDER .
define fluid_series
$(call figure,$(1),flip,$(3))
$(3)/.complete: flip/figures/$(1).sh $(BUILD)/pic $(BUILD)/flip $(2:%=flip/cases/%.toml) | $(packages_first)
	@rm -f $$@
	@mkdir -p $$(@D)
	$$(one_at_a_time) sh $$< $(BUILD)/pic $(BUILD)/flip $$(@D)
	@touch $$@
endef
$(eval $(call fluid_series,flip_sod,sod,out/flip/shock_tubes))
$(eval $(call figure,flip_sod_convergence,flip,out/flip/shock_tubes))
$(eval $(call fluid_series,flip_wall_shock,wall_shock piston,out/flip/struck_walls))
$(eval $(call fluid_series,flip_advected_blob,advected_blob,out/flip/blobs))
$(eval $(call fluid_series,flip_rotating_disk,rotating_disk,out/flip/disks))
$(eval $(call fluid_series,flip_rayleigh_taylor,rayleigh_taylor,out/flip/layers))
$(eval $(call figure,pic_sphere_hits_plate,flip,out/pic/sphere_hits_plate))
$(eval $(call fluid_series,flip_gresho,gresho,out/flip/vortices))
$(eval $(call fluid_series,flip_kelvin_helmholtz,kelvin_helmholtz,out/flip/streams))
$(eval $(call fluid_series,flip_acoustic,acoustic,out/flip/sound_waves))
$(eval $(call fluid_series,flip_ringing,ringing,out/flip/uniform_flows))
$(eval $(call figure,flip_dam_break,flip,out/flip/dam_break))
$(eval $(call figure,flip_dam_break_air,flip,out/flip/dam_break_air))
$(eval $(call figure,flip_cavity,flip,out/flip/cavity))
$(eval $(call fluid_series,flip_translating_frame,translating_frame,out/flip/frames))
$(eval $(call fluid_series,flip_sedov,sedov,out/flip/blasts))
$(eval $(call fluid_series,flip_noh,noh,out/flip/falling))
$(eval $(call fluid_series,flip_collapsing_cavity,collapsing_cavity,out/flip/cavities))
$(eval $(call fluid_series,flip_rotating_column,rotating_column,out/flip/columns))
$(eval $(call fluid_series,flip_gravity_wave,gravity_wave,out/flip/water))
# A script that both share.
out/figures/flip_sedov.png out/figures/flip_noh.png: flip/figures/radial.gp

fluid_figures = $(filter pic_% flip_%,$(figures))

# $(call mpm_series,figure,cases,folder): a figure of several runs of mpm_explicit.
define mpm_series
$(call figure,$(1),mpm_explicit,$(3))
$(call series,mpm_explicit/figures/$(1).sh,mpm_explicit,$(2:%=mpm_explicit/cases/%.toml),$(3))
endef
$(eval $(call mpm_series,fig02,rebound,out/mpm_explicit/rebounds_shown))
$(eval $(call mpm_series,fig05,compressed,out/mpm_explicit/compressions))
$(eval $(call mpm_series,mpm_explicit_energy,rebound,out/mpm_explicit/rebounds))
$(eval $(call figure,mpm_explicit_compressed_energy,mpm_explicit,out/mpm_explicit/compressions))
$(foreach c,shear diametral_disk vibrating_bar yielding_disk column_collapse,\
    $(eval $(call figure,mpm_explicit_$c,mpm_explicit,out/mpm_explicit/$c)))
$(eval $(call mpm_series,mpm_explicit_standing_wave,standing_wave,out/mpm_explicit/standing_waves))
$(eval $(call mpm_series,mpm_explicit_incline,incline_block rolling_cylinder,out/mpm_explicit/inclines))
$(eval $(call mpm_series,mpm_explicit_bonded_bar,bonded_bar,out/mpm_explicit/bonds))
$(eval $(call mpm_series,mpm_explicit_oscillator,oscillator,out/mpm_explicit/oscillators))
$(eval $(call mpm_series,mpm_explicit_sulsky_disks,sulsky_disks,out/mpm_explicit/collisions))
$(eval $(call mpm_series,mpm_explicit_rest,block_at_rest,out/mpm_explicit/rests))
# Of both programs.
$(eval $(call mpm_series,mpm_explicit_flutter,sliding_block,out/mpm_explicit/flutters))
out/mpm_explicit/flutters/.complete: $(BUILD)/mpm_implicit mpm_implicit/cases/sliding_block.toml
$(eval $(call mpm_series,mpm_explicit_plates,plate_holds cyclic_plate,out/mpm_explicit/plates))

# $(call implicit_series,figure,cases,folder): a figure of several runs of mpm_implicit.
define implicit_series
$(call figure,$(1),mpm_implicit,$(3))
$(call series,mpm_implicit/figures/$(1).sh,mpm_implicit,$(2:%=mpm_implicit/cases/%.toml),$(3))
endef
$(eval $(call figure,fig01,mpm_implicit,out/mpm_implicit/rebound))
$(eval $(call implicit_series,fig03,rebound,out/mpm_implicit/rebounds))
$(eval $(call implicit_series,fig04,compressed,out/mpm_implicit/compressions))
$(eval $(call figure,fig06,mpm_implicit,out/mpm_implicit/compressions))
$(eval $(call figure,fig07,mpm_implicit,out/mpm_implicit/shear))
$(foreach c,shear_large diametral_disk,$(eval $(call figure,mpm_implicit_$c,mpm_implicit,out/mpm_implicit/$c)))
$(eval $(call implicit_series,mpm_implicit_identity,rebound,out/mpm_implicit/oblique))
$(eval $(call implicit_series,mpm_implicit_iterations,compressed,out/mpm_implicit/iterations))
# $(call both_series,figure,case,folder): several runs of both, by  sh SCRIPT IMPLICIT EXPLICIT FOLDER .
define both_series
$(call figure,$(1),mpm_implicit,$(3))
$(3)/.complete: mpm_implicit/figures/$(1).sh $(BUILD)/mpm_implicit $(BUILD)/mpm_explicit mpm_implicit/cases/$(2).toml | $(packages_first)
	@rm -f $$@
	@mkdir -p $$(@D)
	$$(one_at_a_time) sh $$< $(BUILD)/mpm_implicit $(BUILD)/mpm_explicit $$(@D)
	@touch $$@
endef
$(eval $(call both_series,mpm_implicit_energy_bound,energy_bound,out/mpm_implicit/bounces))
$(eval $(call both_series,mpm_spin,spinning_disk,out/mpm_implicit/spins))
out/mpm_implicit/spins/.complete: mpm_explicit/cases/spinning_disk.toml
$(eval $(call both_series,mpm_rolling,rolling_cylinder,out/mpm_implicit/rollings))
out/mpm_implicit/rollings/.complete: mpm_explicit/cases/rolling_cylinder.toml
$(eval $(call both_series,mpm_implicit_billet,billet,out/mpm_implicit/billets))
# Figures that look into runs of the explicit program, too.
out/figures/fig03.png: out/mpm_explicit/rebounds/.complete
out/figures/fig06.png: out/mpm_explicit/compressions/.complete

# Pictures in polarized light.
$(patsubst %,out/figures/%.png,fig04 fig05 fig07 mpm_explicit_shear mpm_explicit_diametral_disk \
    mpm_implicit_shear_large mpm_implicit_diametral_disk): mpm_explicit/figures/polariscope.gp
# The implicit side of these is drawn by the script of the explicit one.
out/figures/fig04.png: mpm_explicit/figures/fig05.gp
out/figures/fig07.png: mpm_explicit/figures/mpm_explicit_shear.gp
out/figures/mpm_implicit_diametral_disk.png: mpm_explicit/figures/mpm_explicit_diametral_disk.gp

mpm_figures = $(filter mpm_%,$(figures))

figures: $(figures)

# The same without the zero.
$(foreach n,1 2 3 4 5 6 7 8 9,$(eval .PHONY: fig$n)$(eval fig$n: fig0$n))

# ---- any run -------------------------------------------------------------------------------------

# make plot RUN=out/cic/mine
plot watch movie:
	$(call need,gnuplot)
	@sh common/plot.sh $(@:plot=draw) "$$RUN"
compare:
	$(call need,gnuplot)
	@sh common/plot.sh compare "$$A" "$$B"

# The talk's figures that move, each from a run of its own with many snapshots: program, case and overrides, kind of snapshots, quantities.
define movie
.PHONY: $(1)
movies += $(1)
$(1): $(BUILD)/$(2) | $(packages_first)
	$$(call need,gnuplot)
	@mkdir -p out/movies
	$$(one_at_a_time) $(BUILD)/$(2) $(2:explicit_em=implicit_moment)/cases/$(3) --quiet --resume --out out/movies/$(1)
	@QUANTITIES='$(5)' PLOTS=out/figures/$(1) sh common/movie.sh out/movies/$(1) '$(4)'
endef
$(eval $(call movie,movie01,mpm_implicit,rebound.toml output.particles_interval=0.02,particles))
$(eval $(call movie,movie02,mpm_explicit,rebound.toml time.alpha=1 time.energy_limit=0 output.particles_interval=0.02 \
    grid.cells_x=64 grid.cells_y=32 grid.length_x=1.6 grid.low_x=-0.2 grid.low_y=-0.1,particles))
$(eval $(call movie,movie05,mpm_explicit,compressed.toml output.fringes_interval=0.005,fringes,stress_difference))
$(eval $(call movie,movie07,mpm_implicit,shear.toml output.particles_interval=0.01 output.fringes_interval=0.01,particles fringes,stress_difference))
$(eval $(call movie,movie08,implicit_moment,gem.toml output.fields_interval=10,fields,J_y))
$(eval $(call movie,movie11,implicit_moment,lhdi_quick.toml output.fields_interval=0 current_sheet.temperature_ratio=1 time.dt=0.24,profile,J_x))
$(eval $(call movie,movie12,implicit_moment,lhdi_quick.toml output.fields_interval=4,fields,E_x))
$(eval $(call movie,movie13,implicit_moment,kink_quick.toml output.fields_interval=20,fields,B_y))
movies: $(movies)

# The program is that of the folder of the case, unless PROGRAM names another.
sweep_program = $(if $(filter command environment,$(firstword $(origin PROGRAM))),$(PROGRAM),$(firstword $(subst /, ,$(CASE))))
sweep: $$(addprefix $(BUILD)/,$$(filter $(programs),$$(sweep_program)))
	@PROGRAM=$(sweep_program) BUILD=$(BUILD) sh common/sweep.sh '$(CASE)' $(KEYS)

# ---- tests ---------------------------------------------------------------------------------------

ctest = cd $(BUILD) && env -u MAKEFLAGS -u MFLAGS -u MAKELEVEL \
        ctest --output-on-failure --no-tests=error -j$(JOBS) $(ARGS)

# From the folder of the build, however deep it is.
empty   :=
to_root := $(subst $(empty) ,,$(patsubst %,../,$(subst /, ,$(BUILD))))
$(BUILD)/CTestTestfile.cmake: Makefile | $(packages_first)
	@mkdir -p $(@D)
	@printf '%s\n' 'set(build_folder "$(BUILD)")' 'set(patience $(if $(SANITIZE),10,1))' \
	    'subdirs($(to_root)tests)' > $@

# With MPI=1 the facts about ranks, five minutes; `make test` has them, too, where build/mpi is not empty.
FACTS = refuse bytes restart memory stop
ifneq ($(MPI),)
test: all
	@$(MAKE) MPI= $(programs)
	@set -e; for fact in $(FACTS); do case $$fact in refuse) of=explicit_em ;; *) of='$(programs)' ;; esac; \
	    for p in $$of; do echo $$fact $$p; sh tests/support/ranks.sh $(BUILD:/mpi=) $$fact $$p; done; done
else
test: all tests $(BUILD)/CTestTestfile.cmake | $(packages_first)
	$(call need,ctest)
	$(ctest) -LE long
endif

# Runs that the notes quote and no figure needs.
quoted := out/implicit_moment/gem_1836/.complete $(patsubst %,out/cic/%/.complete,\
    plasma_wave landau upper_hybrid misprint cloud_collision cold_beam_grid_instability thermal_heating)\
    $(patsubst %,out/mpm_explicit/%/.complete,rebound incline_block rolling_cylinder sliding_block bonded_bar)\
    $(patsubst %,out/mpm_implicit/%/.complete,compressed incline_block sliding_block vibrating_bar billet)

test-long: all tests figures $(quoted) $(BUILD)/CTestTestfile.cmake | $(packages_first)
	$(call need,ctest)
	$(ctest) -L long

# ---- exercises -----------------------------------------------------------------------------------

# With an answer nothing is run; else the programs of the exercise are built, with what the student changed in them.
# The answer goes through the environment, whatever quotes it has.
answered := $(filter-out undefined,$(origin ANSWER))
exercise: $(if $(E),$(if $(answered),,$(addprefix $(BUILD)/,$(shell sh common/exercise.sh programs '$(E)' 2>/dev/null))))
	@$(if $(E),,echo "which one? make exercise E=1-3; 'make exercises' lists them" >&2; exit 2;) \
	    BUILD=$(BUILD) sh common/exercise.sh $(if $(answered),answer '$(E)' "$$ANSWER",run '$(E)')
exercises:
	@sh common/exercise.sh list

# ---- the laboratory ------------------------------------------------------------------------------

# Half an hour of bad luck and bad will, with compilers and tools of `make deps-dev`; it can be stopped and goes on.
MINUTES ?= 30
torture: all
	@MINUTES=$(MINUTES) JOBS=$(JOBS) BUILD=$(BUILD) MAKE='$(MAKE)' sh tests/torture/torture.sh

# What the facts of a program do not notice.
PROGRAM ?= cic
N       ?= 50
SEED    ?= 1
RUNS    ?= yes
mutate:
	@PROGRAM=$(PROGRAM) N=$(N) SEED=$(SEED) RUNS=$(RUNS) MAIN=$(filter %/$(PROGRAM).cpp,$(mains)) MAINS='$(mains)' JOBS=$(JOBS) MAKE='$(MAKE)' \
	    CXX='$(CXX)' EIGEN='$(EIGEN)' sh tests/mutate

# Built by it, with clang: each program with all inputs that libFuzzer thinks of, and a race that must be found.
fuzzers: $(programs:%=$(BUILD)/fuzz/%)
$(objects)/fuzz/%.o: $$(call folder_of,$$*)/$$*.cpp $(BUILD)/flags
	@mkdir -p $(@D)
	$(CXX) $(flags) $(defines) -Dmain=program_main $(include_paths) -MMD -MP -c -o $@ $<
$(BUILD)/fuzz/%: $(objects)/fuzz/%.o $(objects)/tests/torture/fuzz.o $(filter-out %/run.o,$(shared)) $(theory) $(formula) $(BUILD)/flags
	@mkdir -p $(@D)
	$(CXX) $(flags) -fsanitize=fuzzer -Wl,--wrap=exit,--wrap=getrlimit,--wrap=_ZNSt6chrono3_V212steady_clock3nowEv \
	    -o $@ $(filter %.o %.a,$^) $(libraries) -Wl,--as-needed -lmuparser -lfftw3 -lfftw3f
$(BUILD)/planted_race: $(objects)/tests/torture/planted_race.o $(BUILD)/flags
	$(link)
-include $(programs:%=$(objects)/fuzz/%.d) $(wildcard $(objects)/tests/torture/*.d)

# ---- speed ---------------------------------------------------------------------------------------

# With MPI=1 two ranks beside one, and what messages cost.
ifneq ($(MPI),)
$(BUILD)/benches/message_times: $(objects)/tests/support/message_times.o $(objects)/common/ranks.o
	$(link)
-include $(objects)/tests/support/message_times.d
bench: all $(BUILD)/benches/message_times
	@sh tests/support/ranks_bench.sh $(BUILD)
else
bench: $(bench_programs)
	@set -e; for b in $^; do $$b; done
endif

# ---- to others -----------------------------------------------------------------------------------

# An installed program finds its cases, and the data that they compare with, beside itself in share/.
PREFIX ?= /usr/local
share   = $(DESTDIR)$(PREFIX)/share/particle-in-cell
install: all
	install -d '$(DESTDIR)$(PREFIX)/bin'
	install $(programs:%=$(BUILD)/%) '$(DESTDIR)$(PREFIX)/bin'
	$(if $(hdf5),install -D -m 644 $(openpmd) '$(DESTDIR)$(PREFIX)/lib/particle-in-cell/openpmd.so')
	for f in $(wildcard */cases/*.toml) $(filter-out %.sh,$(wildcard */data/*)); do install -D -m 644 $$f '$(share)'/$$f || exit; done
	install -m 644 LICENSE README.md CITATION.cff '$(share)'

dist:
	@mkdir -p build
	git archive --prefix=particle-in-cell-$(VERSION)/ -o build/particle-in-cell-$(VERSION).tar.gz HEAD
	@git diff --quiet HEAD || echo "note: what is not committed is not in it" >&2

# ---- the book --------------------------------------------------------------------------------------

# The notes, sources and finished runs as HTML and PDF; and the page of the runs alone, which needs no packages.
.PHONY: deps-book book validation
deps-book: | $(filter deps deps-dev deps-sweep deps-mpi,$(MAKECMDGOALS))
	@sh common/packages.sh pandoc nodejs libjs-katex chromium
book: | $(filter deps deps-book,$(MAKECMDGOALS))
	@sh lecture_notes/book/build.sh
validation:
	@sh common/validation.sh

# ---- in the browser -------------------------------------------------------------------------------

# The programs, their sources unchanged, compiled by Emscripten to out/web/: an index and a page per case, which
# need no server and no network. Headers in instead/ come before all others. GSL and muParser have no package for
# the browser: what the programs call of them is compiled from Debian's sources. FFTW has a stand-in there.
page      := lecture_notes/page
web       := build/web
web_cases := two_stream landau finite_grid sod rayleigh_taylor rebound compressed gem
web_programs := cic pic flip mpm_explicit mpm_implicit implicit_moment
web_flags := -std=c++20 -DBUILD_FLAGS=\"emscripten\" -O3 -msimd128 -fexceptions -fno-math-errno -w -Wno-c++11-narrowing -I$(page)/instead -I. -isystem $(web)/include $(defines)
# Left and entered again between two steps: what may be on the stack there.
web_link  := -O3 -msimd128 -fexceptions -Wl,--wrap=_ZN6common3Run12not_finishedEll,--wrap=_ZN6common3Run12not_finishedEldd \
    -sASYNCIFY -sASYNCIFY_IMPORTS=page_wait \
    -sASYNCIFY_STACK_SIZE=65536 -sASYNCIFY_ONLY="main,*run_*,*__function::*,__wrap_*,dynCall_*" \
    -sMODULARIZE -sEXPORT_NAME=program -sINVOKE_RUN=0 -sALLOW_MEMORY_GROWTH -sINITIAL_MEMORY=64MB -sENVIRONMENT=worker,node \
    -sFORCE_FILESYSTEM -sEXPORTED_RUNTIME_METHODS=callMain,FS
web_gsl   := $(addprefix cdf/,gauss gaussinv tdist tdistinv) randist/tdist fft/fft fit/linear err/error err/stream err/strerror sys/infnan sys/pow_int \
    $(addprefix specfunc/,bessel_I0 beta elementary erfc exp expint gamma gamma_inc log psi trig zeta)
web_muparser := muParser muParserBase muParserBytecode muParserCallback muParserError muParserTokenReader
web_common := $(patsubst %.cpp,$(web)/%.o,$(filter-out %/openpmd.cpp %/ranks.cpp,$(wildcard common/*.cpp common/run/*.cpp */theory/*.cpp)) $(page)/glue.cpp) $(web)/libraries.a
# Emscripten looks for modules of node where Debian puts them.
emscripten := NODE_PATH=/usr/share/nodejs em++

.PHONY: web deps-web test-web
deps-web: deps | $(filter deps-dev deps-sweep deps-mpi deps-book,$(MAKECMDGOALS))
	@sh common/packages.sh emscripten chromium
# With CASES only these, and the programs that they run.
web_wanted = $(or $(CASES),$(web_cases))
web_needed = $(sort $(foreach c,$(web_wanted),$(shell sed -n '/^    $c: {/,/^    }/p' $(page)/cases.js | grep -o 'program: "[a-z_]*' | cut -d'"' -f2)))
web: $(web_wanted:%=out/web/%.html) $(addprefix out/web/,index.html page.css cases.js page.js pictures.js code.js) \
    $(web_needed:%=out/web/programs/%.js)
	@echo "open out/web/$(or $(firstword $(CASES)),index).html in a browser"

$(web)/sources/.complete: $(page)/get_sources.sh | $(packages_first)
	@command -v em++ >/dev/null || { echo "'em++' is not installed: run 'make deps-web'" >&2; exit 2; }
	@rm -rf $(web)/sources $(web)/include
	sh $(page)/get_sources.sh $(web)/sources gsl muparser
	@mkdir -p $(web)/include
	ln -s $(EIGEN)/Eigen $(EIGEN)/unsupported /usr/include/gsl /usr/include/toml++ /usr/include/nlohmann /usr/include/Random123 \
	    /usr/include/xxhash.h /usr/include/muParser*.h $(web)/include
	@printf '#define %s\n' 'HAVE_DECL_FINITE 1' 'HAVE_DECL_ISNAN 1' 'RETURN_IF_NULL(x) if (!x) { return; }' > $(web)/sources/gsl/config.h
	@touch $@
$(web)/libraries.a: $(web)/sources/.complete $(web)/flags
	@rm -f $@
	cd $(web)/sources/gsl && for f in $(web_gsl); do emcc -O3 -w -I. -I../../include -c -o $$(echo $$f | tr / _).o $$f.c || exit; done
	cd $(web)/sources/muparser && for f in $(web_muparser); do emcc -O2 -w -std=c++17 -fexceptions -Iinclude -c -o $$f.o src/$$f.cpp || exit; done
	emar rcs $@ $(web)/sources/*/*.o
$(web)/flags: FORCE $(web)/sources/.complete
	@echo '$(web_flags) $(web_link) $(web_gsl)' | cmp -s - $@ || echo '$(web_flags) $(web_link) $(web_gsl)' > $@
$(web)/%.o: %.cpp $(web)/flags
	@mkdir -p $(@D)
	$(emscripten) $(web_flags) $(if $(filter $<,$(mains)),-Dmain=program_main) -MMD -MP -c -o $@ $<
$(web_programs:%=$(web)/%.js): $(web)/%.js: $(web)/$$(call folder_of,$$*)/$$*.o $(web_common) $(wildcard */cases/*.toml */data/*)
	$(emscripten) $(web_link) -o $@ $(filter %.o %.a,$^) $(foreach d,cases data,$(if $(wildcard $(call method_of,$*)/$d),--embed-file $(call method_of,$*)/$d))
# Script and program as letters, so that a page may take them from a file.
out/web/programs/%.js: $(web)/%.js $(page)/worker.js
	@mkdir -p $(@D)
	{ printf 'programs.%s = {script: "' $*; cat $^ | base64 -w0; printf '",\nwasm: "'; base64 -w0 $(web)/$*.wasm; echo '"};'; } > $@
out/web/code.js: $(addsuffix step.hpp,cic/ flip/pic/ flip/flip/ mpm_explicit/ mpm_implicit/ implicit_moment/)
	@mkdir -p $(@D)
	awk 'BEGIN { printf "const code = {" } FNR == 1 { printf "%s\"%s\": [", (NR > 1 ? "]," : ""), FILENAME } \
	    { gsub(/[\\"]/, "\\\\&"); printf "\"%s\",\n", $$0 } END { print "]};" }' $^ > $@
$(web_cases:%=out/web/%.html): out/web/%.html: $(page)/head.html $(page)/page.html
	@mkdir -p $(@D)
	cat $^ | sed 's/CASE/$*/' > $@
out/web/index.html: $(page)/head.html $(page)/index.html
	@mkdir -p $(@D)
	cat $^ > $@
out/web/%: $(page)/%
	@mkdir -p $(@D)
	cp $< $@
-include $(patsubst %.cpp,$(web)/%.d,$(mains) $(wildcard common/*.cpp common/run/*.cpp */theory/*.cpp) $(page)/glue.cpp)

# In a real browser, without a window: every page, beside the native programs.
test-web: web all
	@command -v chromium >/dev/null || { echo "'chromium' is not installed: run 'make deps-web'" >&2; exit 2; }
	node $(page)/test.mjs $(CASES)

# ---- notes, format, clean ------------------------------------------------------------------------

notes:
	@sh common/notes.sh refresh; status=$$?; sh common/notes.sh write && exit $$status

format:
	@command -v $(CLANG_FORMAT) >/dev/null || \
	    { echo "'$(CLANG_FORMAT)' is not installed: run 'make deps-dev'" >&2; exit 2; }
	$(CLANG_FORMAT) -i $(sources)

clean:
	rm -rf build out
