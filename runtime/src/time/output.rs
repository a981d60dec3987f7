//! Output during a run: rows of tables and field frames, at steps or at multiples of a time between them.
//!
//! Steps do not have to meet output times. A row there is interpolated between the rows at steps, with the same weights for every column of every
//! table, so what balances at the steps balances in and across the tables; a frame is sampled from interpolated unknowns.

use super::ImplicitSystem;
use super::integrator::Point;
use super::schedule::Schedule;
use crate::error::Error;
use crate::generated::{Every, Frames, Record, Table};
use crate::observer::{Frame, Observer};
use crate::record::RunRecord;

/// Which output is due when.
pub struct Outputs {
    tables: &'static [Table],
    table_schedules: Vec<Schedule>,
    frame_schedules: Vec<Schedule>,
}

impl Outputs {
    /// Output of a run that starts at `start` with globals `g`.
    ///
    /// # Errors
    /// A time between two outputs that is not positive.
    pub fn new(
        tables: &'static [Table],
        frames: &'static [Frames],
        start: f64,
        g: &[f64],
    ) -> Result<Self, Error> {
        let schedule = |what: &str, every: &Every| match every {
            Every::Step => Ok(Schedule::every_step()),
            Every::Time(period) if period(g) > 0.0 => Ok(Schedule::multiples(period(g), start)),
            Every::Time(period) => Err(Error::Model(format!(
                "{what} would be written every {}: give a time above zero, as in `every 0.5 s`, or write `every step`",
                period(g)
            ))),
        };
        let of_table = |table: &Table| schedule(&format!("the table `{}`", table.file), &table.every);
        let of_frames = |frames: &Frames| schedule("a field frame", &frames.every);
        Ok(Self {
            tables,
            table_schedules: tables.iter().map(of_table).collect::<Result<_, _>>()?,
            frame_schedules: frames.iter().map(of_frames).collect::<Result<_, _>>()?,
        })
    }

    /// Writes what is due up to the last recorded point, frames in the order of their times. `point` gives unknowns and rates at a time inside the last step.
    pub fn emit(
        &mut self,
        system: &mut dyn ImplicitSystem,
        record: &RunRecord,
        point: impl Fn(f64) -> Point,
        observer: &mut dyn Observer,
    ) -> Result<(), Error> {
        let Some(&end) = record.times().last() else { return Ok(()) };
        for (table, schedule) in self.table_schedules.iter_mut().enumerate() {
            for time in schedule.take(end) {
                observer.row(table, &row(self.tables, table, record, time))?;
            }
        }
        if !observer.wants_frames() {
            return Ok(());
        }
        let schedules = self.frame_schedules.iter_mut().enumerate();
        let mut due: Vec<(f64, usize)> = schedules
            .flat_map(|(k, schedule)| schedule.take(end).into_iter().map(move |time| (time, k)))
            .collect();
        due.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (time, frame) in due {
            let columns = system.sample(frame, &point(time), &record.at(time));
            let mesh = system.present_mesh();
            observer.frame(Frame { frame, time, columns, mesh })?;
        }
        Ok(())
    }
}

/// The row of `tables[table]` at a time [display units]. All tables are interpolated together, whichever of them are due.
fn row(tables: &[Table], table: usize, record: &RunRecord, time: f64) -> Vec<f64> {
    let width = |tables: &[Table]| tables.iter().map(|t| t.columns.len()).sum::<usize>();
    let (first, end) = (width(&tables[..table]), width(&tables[..=table]));
    let columns = || tables.iter().flat_map(|t| t.columns);
    let all = record.interpolate(time, |g| columns().map(|c| (c.value)(g) / c.unit_value).collect());
    all.get(first..end).map_or_else(Vec::new, <[f64]>::to_vec)
}
