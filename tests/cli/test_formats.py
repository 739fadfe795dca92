"""Results in the formats and databases a mapping office keeps them in."""

import os
import pwd
import shutil
import subprocess
import tempfile
from pathlib import Path

import pytest
from osgeo import ogr
from words import OPEN_ELSEWHERE, call

pytestmark = pytest.mark.slow

ROOT = Path(__file__).resolve().parents[2]
QGIS_PROCESS = str(ROOT / "tools" / "qgis_process")
POSTGRES = sorted(Path("/usr/lib/postgresql").glob("*/bin"))[-1:]
PORT = "5433"

ogr.UseExceptions()


def run(*words, folder):
    done = call("run", *words, folder=folder)
    assert done.returncode == 0, done.stderr
    return done


@pytest.fixture(scope="module")
def survey(sample_survey, tmp_path_factory):
    """A folder with spaces and umlauts in its name, a short street in it, and the points of its curbs."""
    folder = tmp_path_factory.mktemp("Straße 7 – Süd")
    shutil.copytree(sample_survey(LENGTH=40, PULSE_RATE=60000, ROTATION_RATE=100), folder, dirs_exist_ok=True, ignore=OPEN_ELSEWHERE)
    run("lanewright:detectcurbs", f"--POINT_CLOUDS={folder / 's.laz'}", f"--TRAJECTORY={folder / 'drive.gpkg'}",
        f"--CURB_POINTS={folder / 'curbs.gpkg'}", folder=folder)
    return folder


def boundaries(survey, folder, destination, trajectory="drive.gpkg"):
    path = trajectory if trajectory.startswith("postgres") else survey / trajectory
    return run("lanewright:fitroadedges", f"--CURB_POINTS={survey / 'curbs.gpkg'}", f"--TRAJECTORY={path}",
               f"--ROAD_EDGES={destination}", folder=folder)


def checked(source, names):
    """Both edges of the street are there, with heights, the CRS, and fields of these names."""
    layer = source.GetLayer(0) if isinstance(source, ogr.DataSource) else source
    fields = {field.GetName() for field in layer.schema}
    assert set(names) <= fields, fields
    features = list(layer)
    assert {feature.GetField("side") for feature in features} == {"left", "right"}
    for feature in features:
        geometry = feature.GetGeometryRef()
        assert geometry.Is3D() and geometry.Length() > 0.5
        assert abs(geometry.GetZ(0)) > 0.5
    assert "32650" in layer.GetSpatialRef().ExportToWkt() or layer.GetSpatialRef().GetAuthorityCode(None) == "32650" or \
        "zone 50N" in layer.GetSpatialRef().ExportToWkt().replace("_", " ")


@pytest.mark.parametrize("name", ["edges.gpkg", "edges.fgb", "edges.shp", "edges.geojson"])
def test_edges_keep_heights_fields_and_crs(survey, tmp_path, name):
    boundaries(survey, tmp_path, name)
    if name.endswith("json"):  # GeoJSON is in longitude and latitude by its definition
        source = ogr.Open(str(tmp_path / name))
        assert source.GetLayer(0).GetFeatureCount() >= 2 and source.GetLayer(0).GetNextFeature().GetGeometryRef().Is3D()
        return
    checked(ogr.Open(str(tmp_path / name)), ["side", "status", "station_m", "height_m", "agree_cm", "length_m"])


def test_a_drawing_takes_the_lines_with_their_heights(survey, tmp_path):
    boundaries(survey, tmp_path, "edges.gpkg")
    done = subprocess.run([QGIS_PROCESS, "run", "native:dxfexport", f"--LAYERS={tmp_path / 'edges.gpkg'}",
                           "--EXPORT_LINES_WITH_ZERO_WIDTH=true", "--CRS=EPSG:32650", "--OUTPUT=edges.dxf"],
                          cwd=tmp_path, capture_output=True, text=True, stdin=subprocess.DEVNULL)
    assert done.returncode == 0, done.stderr
    drawing = ogr.Open(str(tmp_path / "edges.dxf"))
    lines = [feature.GetGeometryRef().Clone() for feature in drawing.GetLayer(0)]
    assert len(lines) >= 2 and all(line.Is3D() and abs(line.GetZ(0)) > 0.5 for line in lines)


@pytest.mark.parametrize("name, says", [("edges.dxf", "Export layers to DXF"), ("edges.lines", "no format that QGIS writes")])
def test_a_format_that_cannot_hold_the_result_is_refused_before_the_work(survey, tmp_path, name, says):
    done = call("run", "lanewright:detectboundaries", f"--POINT_CLOUDS={survey / 's.laz'}", f"--TRAJECTORY={survey / 'drive.gpkg'}",
                f"--ROAD_EDGES={name}", folder=tmp_path)
    assert done.returncode == 1 and says in done.stderr and "Reading" not in done.stdout
    assert not list(tmp_path.iterdir())


@pytest.fixture(scope="module")
def database():
    """A PostgreSQL of our own with PostGIS, on a socket in a folder of its own."""
    if not POSTGRES or not list(Path("/usr/share/postgresql").glob("*/extension/postgis.control")):
        pytest.skip("PostgreSQL with PostGIS is not installed: apt install postgresql postgresql-postgis")
    folder = Path(tempfile.mkdtemp(prefix="lanewright-pg-"))
    user = "postgres" if os.geteuid() == 0 else pwd.getpwuid(os.geteuid()).pw_name
    as_user = ["runuser", "-u", user, "--"] if os.geteuid() == 0 else []
    if as_user:
        shutil.chown(folder, user)

    def tool(name, *arguments):
        subprocess.run([*as_user, str(POSTGRES[0] / name), *arguments], cwd=folder, check=True, stdout=subprocess.DEVNULL)

    tool("initdb", "-D", str(folder / "data"), "-U", "lane", "--auth=trust", "-E", "UTF8", "--locale=C.UTF-8")
    tool("pg_ctl", "-D", str(folder / "data"), "-w", "-l", str(folder / "log"), "start", "-o",
         f"-k {folder} -p {PORT} -c listen_addresses=''")
    try:
        def sql(text):
            return subprocess.run(["psql", "-h", str(folder), "-p", PORT, "-U", "lane", "-d", "postgres", "-Atc", text],
                                  check=True, capture_output=True, text=True).stdout.strip()

        sql("CREATE EXTENSION postgis")
        sql("CREATE SCHEMA survey_7")
        yield f"dbname='postgres' host={folder} port={PORT} user='lane'", sql
    finally:
        tool("pg_ctl", "-D", str(folder / "data"), "-m", "immediate", "stop")
        shutil.rmtree(folder, ignore_errors=True)


def test_edges_go_straight_into_postgis_and_a_second_run_replaces_them(survey, tmp_path, database):
    where, sql = database
    for _ in range(2):
        boundaries(survey, tmp_path, f"postgres://{where} table=\"survey_7\".\"road_edges\" (geom)")
    assert int(sql("SELECT count(*) FROM survey_7.road_edges")) >= 2
    assert sql("SELECT count(DISTINCT side) FROM survey_7.road_edges") == "2"
    assert sql("SELECT bool_and(ST_NDims(geom) = 3 AND ST_SRID(geom) = 32650) FROM survey_7.road_edges") == "t"
    assert float(sql("SELECT max(abs(ST_Z(ST_StartPoint(geom)))) FROM survey_7.road_edges")) > 0.5


def test_a_trajectory_comes_from_postgis(survey, tmp_path, database):
    where, _ = database
    run("lanewright:importtrajectory", f"--INPUT={survey / 'drive.gpkg'}",
        f"--OUTPUT=postgres://{where} table=\"survey_7\".\"drive\" (geom)", folder=tmp_path)
    boundaries(survey, tmp_path, "edges.gpkg", trajectory=f"postgres://{where} table=\"survey_7\".\"drive\" (geom)")
    checked(ogr.Open(str(tmp_path / "edges.gpkg")), ["side"])


def test_who_opens_a_table_of_postgis_sees_the_style_and_learns_which_result_of_which_run_it_is(survey, tmp_path, database, qgis_app):
    from lanewright.processing_provider.results.road_maps import origin_of
    from qgis.core import QgsVectorLayer

    where, _ = database
    boundaries(survey, tmp_path, f"postgres://{where} table=\"survey_7\".\"b12_borders\" (geom)")
    layer = QgsVectorLayer(f"{where} key='id' table=\"survey_7\".\"b12_borders\" (geom)", "anything", "postgres")
    assert layer.isValid()
    origin = origin_of(layer)
    assert (origin.provenance.algorithm, origin.output) == ("fitroadedges", "ROAD_EDGES")
    assert layer.renderer().type() != "singleSymbol"


@pytest.fixture
def connection(database, kept_connection):
    """The database as a connection that QGIS keeps, with its password; what it is called."""
    return kept_connection("B12", f"{database[0]} password='secret'", saveUsername=True, savePassword=True)  # pragma: allowlist secret


def test_the_tables_of_a_client_take_all_of_a_map_or_nothing(survey, tmp_path, database, connection):
    sql = database[1]
    sql('CREATE SCHEMA client; CREATE TABLE client."Achsen" ("CODE" text, road text NOT NULL, geom geometry(LineString, 32650))')
    boundaries(survey, tmp_path, "edges.gpkg")

    def delivered(*rows, schema="client", connection=connection):
        (tmp_path / "office.csv").write_text("\n".join(["from;where;layer;CODE;NO:int", *rows]))
        return call("run", "lanewright:exporttemplate", "--TEMPLATE=office.csv", "--ROAD_EDGES=edges.gpkg", f"--CONNECTION={connection}",
                    f"--SCHEMA={schema}", folder=tmp_path)

    for row, says in (("ROAD_EDGES;;Achsen;A1;", "could not be written"), ("ROAD_EDGES;;Achsen;A1;{number}", "has no field NO")):
        refused = delivered("ROAD_EDGES;side=left;Borde;B1;{number}", row.replace("ROAD_EDGES;;", "ROAD_EDGES;side=right;"))
        assert refused.returncode == 1 and says in refused.stderr and "secret" not in refused.stderr + refused.stdout
        assert sql("SELECT to_regclass('client.\"Borde\"') IS NULL AND count(*) = 0 FROM client.\"Achsen\"") == "t"
    for given, says in ((dict(schema="clients"), "there is no schema clients"), (dict(schema=""), "Nothing says where the map goes"),
                        (dict(connection="B13"), "QGIS keeps no connection B13 to PostgreSQL. It keeps: B12.")):
        refused = delivered("ROAD_EDGES;;Borde;B1;{number}", **given)
        assert refused.returncode == 1 and says in refused.stderr and "secret" not in refused.stderr + refused.stdout
    sql('ALTER TABLE client."Achsen" ALTER road DROP NOT NULL')
    for run_number in (1, 2):
        done = delivered("ROAD_EDGES;side=left;Borde;B1;{number}", "ROAD_EDGES;side=right;Achsen;A1;")
        assert done.returncode == 0, done.stderr
        assert sql('SELECT count(*) FROM client."Borde"') == str(run_number * int(sql('SELECT max("NO") FROM client."Borde"')))
    assert sql('SELECT bool_and("CODE" = \'B1\' AND ST_NDims(geom) = 3 AND ST_SRID(geom) = 32650) FROM client."Borde"') == "t"
    assert sql('SELECT bool_and("CODE" = \'A1\' AND ST_NDims(geom) = 2) FROM client."Achsen"') == "t"
