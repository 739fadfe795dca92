"""Columns of a trajectory assigned in the dialog of Import trajectory."""

import numpy as np
import pytest
from lanewright.desktop.survey_widgets import ColumnsWidget, ColumnsWrapper
from qgis.core import QgsApplication


@pytest.fixture
def drive(tmp_path):
    """10 m/s eastward; time, y, x, z without names."""
    second = np.arange(0.0, 20.05, 0.1)
    path = tmp_path / "drive.csv"
    np.savetxt(path, np.c_[318_204_000.0 + second, 5_400_000.0 + 0 * second, 500_000.0 + 10 * second, 78.5 + 0 * second], fmt="%.3f", delimiter=",")
    return str(path)


def choose(widget, column, role):
    box = widget.boxes[column]
    box.setCurrentIndex(box.findData(role))
    box.activated.emit(box.currentIndex())


def test_what_was_understood_is_told_and_nothing_is_shown_without_a_file(qgis_app, drive):
    widget = ColumnsWidget()
    assert widget.table.isHidden() and widget.message.isHidden()
    widget.show_file(drive)
    assert [box.currentData() for box in widget.boxes] == ["time", "y", "x", "z"] and widget.value() == ""
    assert "201 positions over 200 m" in widget.message.text() and "36 km/h" in widget.message.text() and "adjusted GPS" in widget.message.text()
    assert widget.table.item(1, 2).text() == "500000"


def test_a_role_given_to_another_column_leaves_its_former_one(qgis_app, drive):
    widget = ColumnsWidget()
    widget.show_file(drive)
    choose(widget, 2, "z")
    assert widget.value() == "time,y,z,-" and "no x" in widget.message.text()
    choose(widget, 3, "x")
    assert widget.value() == "time,y,z,x" and "positions" in widget.message.text()


def test_of_a_log_it_is_told_what_was_understood_and_there_is_nothing_to_assign(qgis_app, tmp_path):
    path = tmp_path / "drive.nmea"
    path.write_text("".join(f"$GPRMC,1000{k:02d}.00,A,4830.0000,N,00900.0000,E,1,2,131021,,*00\n"
                            f"$GPGGA,1000{k:02d}.00,4830.{50 * k:04d},N,00900.0000,E,4,12,0.9,300.0,M,48.0,M,,*00\n" for k in range(30)))
    widget = ColumnsWidget()
    widget.show_file(str(path))
    assert widget.table.isHidden() and "30 positions" in widget.message.text() and "GPS seconds since 1980" in widget.message.text()


def test_another_file_begins_anew_and_a_layer_has_no_columns(qgis_app, drive, tmp_path):
    widget = ColumnsWidget()
    widget.show_file(drive)
    widget.line.setText("time,y,x,z")
    other = tmp_path / "other.csv"
    other.write_text("x,y,z\n" + "\n".join(f"{500000 + k},5400000,30" for k in range(20)), encoding="utf-8")
    widget.show_file(str(other))
    assert widget.value() == "" and [box.currentData() for box in widget.boxes] == ["x", "y", "z"] and "no time" in widget.message.text()
    widget.show_file("")
    assert widget.table.isHidden()


def test_the_dialog_follows_the_file_that_is_chosen_and_runs_with_what_was_assigned(provider, drive, monkeypatch):
    from processing.gui import ParametersPanel

    monkeypatch.setattr(ParametersPanel, "iface", None)  # pytest-qgis has a stand-in that this panel refuses
    dialog = QgsApplication.processingRegistry().createAlgorithmById("lanewright:importtrajectory").createCustomParametersWidget(None)
    wrapper = dialog.mainWidget().wrappers["COLUMNS"]
    assert isinstance(wrapper, ColumnsWrapper)
    dialog.setParameters({"INPUT": drive})
    assert len(wrapper.widget.boxes) == 4
    choose(wrapper.widget, 3, "")
    assert dialog.createProcessingParameters()["COLUMNS"] == "time,y,x,-"
